// Beside the picture: what the robot decides and why, and what has happened so far.

import { create, find } from "./dom.js";
import { decimal, join, percent, phrase, text } from "./texts.js";

/** @import { Acted, Belief, Decided, Observed, Phrase, Scene } from "./messages.js" */

const MOST_ROWS = 12;

/** Why the robot acts, and what each action is worth. */
export class DecisionPanel {
  #body = find("#values tbody", HTMLTableSectionElement);
  /**
   * @type {Map<string, { row: HTMLTableRowElement, belief: HTMLElement, asking: HTMLElement, picking: HTMLElement }>}
   */
  #rows = new Map();
  /** @type {Decided | null} */
  #decided = null;

  /** @param {Scene} scene */
  set(scene) {
    this.#rows.clear();
    this.#body.replaceChildren();
    for (const item of scene.items.slice(0, MOST_ROWS)) {
      const row = this.#body.insertRow();
      row.append(create("th", { scope: "row", textContent: item.id }));
      this.#rows.set(item.id, { row, belief: row.insertCell(), asking: row.insertCell(), picking: row.insertCell() });
    }
    find("#waiting").textContent = "";
    find("#why").textContent = text("nothing");
    this.#decided = null;
  }

  /** @param {Belief} belief */
  believe(belief) {
    for (const [id, cells] of this.#rows) cells.belief.textContent = percent(belief[id]);
  }

  /** @param {Decided} message */
  decide(message) {
    this.#decided = message;
    const { action, item, values } = message;
    if (message.phrase) find("#why").textContent = sentence(message.phrase);
    if (!values) return;
    for (const [id, { row, asking, picking }] of this.#rows) {
      row.classList.toggle("about", id === item);
      fill(asking, values.point[id], action === "point" && id === item);
      fill(picking, values.pick[id], action === "pick" && id === item);
    }
    fill(find("#waiting"), values.wait, action === "wait");
  }

  /** Say it again, in a language that was chosen meanwhile. */
  translate() {
    if (this.#decided) this.decide(this.#decided);
  }
}

/** @param {HTMLElement} cell @param {number | null} value @param {boolean} best */
function fill(cell, value, best) {
  cell.textContent = value === null ? "–" : decimal(value);
  cell.classList.toggle("best", best);
}

/** @param {Phrase} why */
function sentence(why) {
  const words = phrase(why);
  return `${words[0].toUpperCase()}${words.slice(1)}.`;
}

/** What was heard, seen and done, a line each. */
export class EventLog {
  #list = find("#log");
  /** @type {HTMLElement | null} */
  #open = null; // the last line, while what it did to the belief may still be added

  clear() {
    this.#list.replaceChildren();
    this.#open = null;
  }

  /** @param {Observed | Acted} event */
  add(event) {
    const said = create("span", { textContent: event.type === "observed" ? perceived(event) : acted(event) });
    const time = create("time", { textContent: event.t === undefined ? "" : `${decimal(event.t).slice(0, -1)} s` });
    this.#list.append(create("li", {}, time, said));
    const lines = find("#event-lines");
    lines.scrollTop = lines.scrollHeight;
    this.#open = event.type === "observed" ? said : null;
  }

  /**
   * Add to the last line what it did to the belief. even: whether all items count as equally likely.
   * @param {Belief} belief
   * @param {boolean} even
   */
  conclude(belief, even) {
    this.#open?.append(create("em", { textContent: ` → ${even ? text("evenly") : leaders(belief)}` }));
    this.#open = null;
  }
}

/** The likeliest items: up to three that are at least half as likely as the first. @param {Belief} belief */
export function leaders(belief) {
  const sorted = Object.entries(belief).sort((one, other) => other[1] - one[1]);
  const leading = sorted.filter(([, share]) => share > sorted[0][1] / 2),
    named = leading.slice(0, 3).map(([id, share]) => `${id} ${percent(share)}`);
  if (leading.length > 3) named.push(text("more", { number: leading.length - 3 }));
  return text("leads", { items: join(named) });
}

/** @param {Observed} event */
function perceived({ observation, unknown, reading, anew }) {
  const parts = [];
  if (anew) parts.push(text("anew"));
  if (observation.utterance) parts.push(text("heard", { words: observation.utterance }));
  if (observation.head) parts.push(text("pointed"));
  if (reading) parts.push(text(reading.whose ? "read_whose" : "read", { meaning: reading.meaning }));
  if (unknown.length) parts.push(text("unknown", { words: unknown.join(", ") }));
  return parts.join("; ");
}

/** What the robot did, and why it failed if it did and knows. @param {Acted} event */
export function acted({ action, item, outcome, reason }) {
  if (outcome === "returned") return text("returned", { item });
  const line = text(action === "point" ? "asked" : "handed", { item });
  if (outcome === "done") return line;
  const told = text(outcome === "stopped" ? "stopped" : "not_done", { action: line });
  return reason ? `${told} (${reason})` : told;
}
