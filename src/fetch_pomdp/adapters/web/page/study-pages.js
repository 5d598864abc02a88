// The pages of a study, in the place of the table: what people read, agree to and fill in.

import { create } from "./dom.js";
import { currentLanguage, fallbackLanguage, inLanguage, text } from "./texts.js";

/** @import { Connection } from "./connection.js" */
/** @import { ConsentStage, DoneStage, InstructionsStage, LastStage, PageStage } from "./messages.js" */
/** @import { Question, QuestionsStage, Texts } from "./messages.js" */
/** @typedef {HTMLInputElement | HTMLTextAreaElement} Input */

export class StudyPages {
  /** @type {PageStage | null} */
  #shown = null;

  /**
   * @param {HTMLElement} section where they are shown
   * @param {Connection} connection
   * @param {(language: string) => void} onLanguage called with a language that was chosen
   */
  constructor(section, connection, onLanguage) {
    this.section = section;
    this.connection = connection;
    this.onLanguage = onLanguage;
  }

  /**
   * Show a stage; one that is shown already, as after a lost connection, keeps what was filled in.
   * @param {PageStage} stage
   */
  show(stage) {
    const same = this.#shown?.stage === stage.stage && orderOf(this.#shown) === orderOf(stage);
    const filled = same ? this.#filled() : new Map();
    this.#shown = stage;
    this.section.replaceChildren(...this.#page(stage));
    this.#fill(filled);
    if (!same) this.section.querySelector("h2")?.focus();
  }

  /** Show it again, in a language that was chosen meanwhile. */
  translate() {
    if (this.#shown) this.show(this.#shown);
  }

  hide() {
    this.#shown = null;
    this.section.replaceChildren();
  }

  /** @param {PageStage} stage */
  #page(stage) {
    switch (stage.stage) {
      case "consent":
        return this.#consent(stage);
      case "instructions":
        return this.#instructions(stage);
      case "questions":
        return this.#questions(stage);
      case "done":
        return this.#done(stage);
      default:
        return this.#last(stage);
    }
  }

  /** @param {ConsentStage} stage */
  #consent({ title, text: words, keep_sound: keepsSound }) {
    const languages = [
      ["en", "English"],
      ["de", "Deutsch"],
    ].map(([name, label]) => {
      const choice = button(label, () => this.onLanguage(name));
      choice.lang = name;
      choice.setAttribute("aria-pressed", String(currentLanguage() === name));
      return choice;
    });
    const keep = create("input", { type: "checkbox", name: "sound" });
    const form = this.#form("consent", () => ({
      taking_part: true,
      sound: keepsSound && keep.checked,
      language: currentLanguage(),
    }));
    const sound = keepsSound
      ? create("p", {}, create("label", {}, keep, ` ${text("consent_sound")}`))
      : create("p", { className: "note", textContent: text("consent_no_sound") });
    const refuse = button(text("consent_no"), () =>
      this.connection.send({ type: "reply", stage: "consent", values: { taking_part: false } }),
    );
    form.append(sound, create("p", { className: "buttons" }, strong("consent_yes"), refuse));
    return [
      heading(inLanguage(title), fallbackLanguage(title)),
      create("p", { className: "buttons" }, ...languages),
      ...prose(words),
      form,
    ];
  }

  /** @param {InstructionsStage} stage */
  #instructions({ text: words, code, ears, practice, of }) {
    const form = this.#form("instructions", () => ({}));
    form.append(strong(practice ? "to_practice" : "to_trials"));
    const ways = ["how_type", ...(ears ? ["how_speak"] : []), "how_point", "how_keys"];
    const how = create("ul", {}, ...ways.map((key) => create("li", { textContent: text(key) })));
    const counts = create("p", { textContent: text(practice ? "counts_practice" : "counts", { practice, of }) });
    return [
      heading(text("instructions")),
      ...prose(words),
      create("h3", { textContent: text("how") }),
      how,
      counts,
      ownCode(code),
      form,
    ];
  }

  /** @param {QuestionsStage} stage */
  #questions({ questions, order, of }) {
    const form = this.#form("questions", () =>
      Object.fromEntries(questions.map((question) => [question.id, answer(form, question)])),
    );
    form.append(...questions.map(questionElement), strong("questions_send"));
    const page =
      of > 1 ? [create("p", { className: "note", textContent: text("questions_page", { page: order + 1, of }) })] : [];
    return [heading(text("questions")), ...page, form];
  }

  /** @param {DoneStage} stage */
  #done({ completion, code }) {
    const note = create("p", { textContent: text("done_completion") }),
      shown = create("p", { className: "code", textContent: completion });
    return [heading(text("done")), note, shown, ownCode(code), this.#anew("somebody_else")];
  }

  /** @param {LastStage} stage */
  #last({ stage }) {
    return [heading(text(stage)), create("p", { textContent: text(`${stage}_note`) }), this.#anew("begin_anew")];
  }

  /** @param {string} key */
  #anew(key) {
    return create(
      "p",
      { className: "buttons" },
      button(text(key), () => {
        this.connection.forget();
        location.reload();
      }),
    );
  }

  /** @param {string} stage @param {() => Record<string, unknown>} values */
  #form(stage, values) {
    const form = create("form", { autocomplete: "off" });
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.connection.send({ type: "reply", stage, values: values() });
    });
    return form;
  }

  /** @returns {Input[]} */
  #inputs() {
    return [...this.section.querySelectorAll("input"), ...this.section.querySelectorAll("textarea")];
  }

  #filled() {
    return new Map(
      this.#inputs().map((input) => [nameOf(input), input instanceof HTMLInputElement ? input.checked : input.value]),
    );
  }

  /** @param {Map<string, string | boolean>} filled */
  #fill(filled) {
    for (const input of this.#inputs()) {
      const value = filled.get(nameOf(input));
      if (typeof value === "boolean" && input instanceof HTMLInputElement) input.checked = value;
      else if (typeof value === "string") input.value = value;
    }
  }
}

/** @param {PageStage | null} stage */
const orderOf = (stage) => (stage?.stage === "questions" ? stage.order : null);

/** @param {Input} input */
const nameOf = (input) => `${input.name}=${input instanceof HTMLInputElement ? input.value : ""}`;

/** @param {string} words */
function heading(words, lang = "") {
  return create("h2", { textContent: words, tabIndex: -1, lang });
}

/** @param {string} label @param {() => void} onClick */
function button(label, onClick) {
  const made = create("button", { type: "button", textContent: label });
  made.addEventListener("click", onClick);
  return made;
}

/** @param {string} key */
function strong(key) {
  return create("button", { className: "strong", textContent: text(key) });
}

/** @param {string} code */
function ownCode(code) {
  const [before, after] = text("your_code", { code: "\n" }).split("\n");
  return create("p", { className: "note" }, before, create("strong", { textContent: code }), after);
}

/** A text with paragraphs and lists. @param {Texts} texts */
function prose(texts) {
  const lang = fallbackLanguage(texts);
  return inLanguage(texts)
    .trim()
    .split(/\n\s*\n/)
    .map((block) => {
      const lines = block.split("\n");
      if (!lines.every((line) => line.startsWith("- "))) return create("p", { textContent: block, lang });
      return create("ul", { lang }, ...lines.map((line) => create("li", { textContent: line.slice(2) })));
    });
}

/** @param {Question} question */
function questionElement(question) {
  const words = inLanguage(question.text),
    lang = fallbackLanguage(question.text),
    name = `q-${question.id}`;
  const optional = question.required
    ? []
    : [create("span", { className: "note", textContent: ` ${text("optional")}` })];
  if (question.kind === "text") {
    const label = create("label", { htmlFor: name, lang }, words, ...optional);
    return create(
      "p",
      { className: "question" },
      label,
      create("textarea", { id: name, name, rows: 4, maxLength: 5000, required: question.required }),
    );
  }
  const legend = create("legend", { lang }, words, ...optional);
  return create(
    "fieldset",
    { className: `question ${question.kind}` },
    legend,
    ...(question.kind === "scale" ? [scale(question, name)] : choices(question, name)),
  );
}

/** A row of numbers between two ends. @param {Question} question @param {string} name */
function scale({ options, points, required }, name) {
  const [low, high] = options.map((option) => inLanguage(option.text));
  const labels = Array.from({ length: points }, (_, index) => {
    const end = index === 0 ? low : index === points - 1 ? high : null,
      value = String(index + 1);
    const label = create("label", {}, create("input", { type: "radio", name, value, required }), ` ${value}`);
    if (end) label.append(create("span", { className: "hidden", textContent: `: ${end}` }));
    return label;
  });
  /** @param {string} words */
  const side = (words) => create("span", { className: "end", textContent: words, ariaHidden: "true" });
  return create("div", { className: "points" }, side(low), ...labels, side(high));
}

/** One of several, or any number of them. @param {Question} question @param {string} name */
function choices({ kind, options, required }, name) {
  const input = { type: kind === "choices" ? "checkbox" : "radio", name, required: required && kind === "choice" };
  return options.map(({ id, text: words }) =>
    create(
      "label",
      { lang: fallbackLanguage(words) },
      create("input", { ...input, value: id }),
      ` ${inLanguage(words)}`,
    ),
  );
}

/** @param {HTMLFormElement} form @param {Question} question */
function answer(form, question) {
  const name = `q-${question.id}`;
  if (question.kind === "text")
    return [...form.querySelectorAll("textarea")].find((input) => input.name === name)?.value;
  const chosen = [...form.querySelectorAll("input")]
    .filter((input) => input.name === name && input.checked)
    .map((input) => input.value);
  if (question.kind === "choices") return chosen;
  if (!chosen.length) return null;
  return question.kind === "scale" ? Number(chosen[0]) : chosen[0];
}
