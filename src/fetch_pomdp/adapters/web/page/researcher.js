// The researcher's page: how far everybody is, again and again, and all that was kept as a ZIP file.

import { create, find } from "./dom.js";
import { currentLanguage, inLanguage, preferredLanguage, setLanguage, text } from "./texts.js";

/** @import { Texts } from "./messages.js" */
/**
 * @typedef {object} Participant
 * @property {string | number} person
 * @property {string} code
 * @property {string} stage
 * @property {number} trials_done
 * @property {number} of
 * @property {number} interruptions
 * @property {number} given_up
 * @property {string} joined ISO 8601, as is `last`
 * @property {string} last
 */
/** @typedef {{ name: string, title: Texts, people: number, progress: Participant[] }} Progress */

const PERIOD = 5000; // ms

class ResearcherPage {
  /** @type {Progress | null} */
  #progress = null;
  #state = find("#state");
  #export = find("#export", HTMLButtonElement);
  #language = find("#language", HTMLSelectElement);

  /** @param {string | null} token */
  constructor(token) {
    this.token = token;
    this.#language.addEventListener("change", () => this.#choose(this.#language.value));
    this.#export.addEventListener("click", () => this.#save());
    this.#choose(preferredLanguage());
    if (token) this.#refresh();
    else this.#state.textContent = text("researcher_key");
  }

  /** @param {string} path */
  #ask(path) {
    return fetch(path, { headers: { authorization: `Bearer ${this.token}` }, cache: "no-store" });
  }

  async #refresh() {
    let again = true;
    try {
      const answer = await this.#ask("researcher/progress");
      again = answer.status !== 401 && answer.status !== 404;
      if (answer.ok) this.#show(await answer.json());
      else
        this.#state.textContent = text(
          answer.status === 401 ? "researcher_wrong" : answer.status === 404 ? "researcher_key" : "researcher_lost",
        );
    } catch {
      this.#state.textContent = text("researcher_lost");
    }
    if (again) setTimeout(() => this.#refresh(), PERIOD);
  }

  /** @param {Progress} study */
  #show(study) {
    this.#progress = study;
    const { title, people, progress } = study;
    find("h1").textContent = document.title = `${inLanguage(title)}: ${text("researcher")}`;
    const done = progress.filter((each) => each.stage === "done").length,
      idle = progress.filter((each) => each.of > 0 && each.trials_done === 0).length;
    const line = text("researcher_people", { there: progress.length, people, done, idle });
    if (this.#state.textContent !== line) this.#state.textContent = line; // what stays the same is not read aloud again
    this.#export.disabled = progress.length === 0;
    find("#nobody").hidden = progress.length > 0;
    find("tbody").replaceChildren(...progress.map(row));
  }

  async #save() {
    this.#export.disabled = true;
    this.#state.textContent = text("exporting");
    try {
      const answer = await this.#ask("researcher/export");
      if (!answer.ok || !this.#progress) throw new Error(answer.statusText);
      const link = create("a", {
        href: URL.createObjectURL(await answer.blob()),
        download: `${this.#progress.name}.zip`,
      });
      link.click();
      URL.revokeObjectURL(link.href);
      this.#show(this.#progress);
    } catch {
      this.#state.textContent = text("researcher_lost");
      this.#export.disabled = false;
    }
  }

  /** @param {string} language */
  #choose(language) {
    setLanguage(language);
    this.#language.value = language;
    if (this.#progress) this.#show(this.#progress);
  }
}

/** @param {Participant} each */
function row(each) {
  const made = create("tr", {}, create("th", { scope: "row", textContent: String(each.person) }));
  for (const value of [
    each.code,
    text(`stage_${each.stage}`),
    `${each.trials_done} / ${each.of}`,
    each.interruptions,
    each.given_up,
    time(each.joined),
    time(each.last),
  ]) {
    made.insertCell().textContent = String(value);
  }
  return made;
}

/** @param {string} iso */
const time = (iso) =>
  new Intl.DateTimeFormat(currentLanguage(), { dateStyle: "short", timeStyle: "short" }).format(new Date(iso));

new ResearcherPage(new URLSearchParams(location.hash.slice(1)).get("token"));
