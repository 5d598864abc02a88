// What people read, agree to and fill in: a sheet in the place of the table.

import { currentLanguage, text } from "./texts.js";

const element = (name, { lang, ...properties } = {}, ...children) => {
  const made = Object.assign(document.createElement(name), properties);
  if (lang) made.lang = lang;
  made.append(...children);
  return made;
};
export const inLanguage = (texts) => texts[currentLanguage()] ?? texts.en;
const languageOf = (texts) => (currentLanguage() in texts ? "" : "en");

export class Paper {
  constructor(sheet, connection, choose) {
    this.sheet = sheet;
    this.connection = connection;
    this.choose = choose; // called with a language
    this.shown = null;
  }

  // Show a stage; one that is shown already, as after a lost connection, keeps what was filled in.
  show(message) {
    const same = this.shown?.stage === message.stage && this.shown?.order === message.order;
    const filled = same ? this.#filled() : new Map();
    this.shown = message;
    this.sheet.replaceChildren(...this[message.stage](message));
    this.#fill(filled);
    if (!same) this.heading.focus();
  }

  again() {
    if (this.shown) this.show(this.shown);
  }

  hide() {
    this.shown = null;
    this.sheet.replaceChildren();
  }

  // The stages.

  consent({ title, text: words, keep_sound: keepsSound }) {
    const form = this.#form("consent", () => ({ taking_part: true, sound: form.elements.sound?.checked ?? false, language: currentLanguage() }));
    const languages = element("p", { className: "buttons" });
    for (const [name, label] of [["en", "English"], ["de", "Deutsch"]]) {
      const button = this.#button(label, () => this.choose(name));
      button.lang = name;
      button.setAttribute("aria-pressed", String(currentLanguage() === name));
      languages.append(button);
    }
    const sound = keepsSound
      ? element("p", {}, element("label", {}, element("input", { type: "checkbox", name: "sound" }), ` ${text("consent_sound")}`))
      : element("p", { className: "note", textContent: text("consent_no_sound") });
    const refuse = this.#button(text("consent_no"), () => this.connection.send({ type: "reply", stage: "consent", values: { taking_part: false } }));
    form.append(sound, element("p", { className: "buttons" }, element("button", { className: "strong", textContent: text("consent_yes") }), refuse));
    return [this.#heading(inLanguage(title), languageOf(title)), languages, ...this.#prose(words), form];
  }

  instructions({ text: words, code, ears, practice, of }) {
    const form = this.#form("instructions", () => ({}));
    form.append(element("button", { className: "strong", textContent: text(practice ? "to_practice" : "to_trials") }));
    const how = element("ul", {}, ...["how_type", ears ? "how_speak" : null, "how_point", "how_keys"].filter(Boolean).map((key) => element("li", { textContent: text(key) })));
    const counts = element("p", { textContent: text(practice ? "counts_practice" : "counts", { practice, of }) });
    return [this.#heading(text("instructions")), ...this.#prose(words), element("h3", { textContent: text("how") }), how, counts, this.#code(code), form];
  }

  questions({ questions, order, of }) {
    const form = this.#form("questions", () => Object.fromEntries(questions.map((question) => [question.id, answer(form, question)])));
    form.append(...questions.map((question) => this.#question(question)), element("button", { className: "strong", textContent: text("questions_send") }));
    const page = of > 1 ? [element("p", { className: "note", textContent: text("questions_page", { page: order + 1, of }) })] : [];
    return [this.#heading(text("questions")), ...page, form];
  }

  done({ completion, code }) {
    const note = element("p", { textContent: text("done_completion") }), shown = element("p", { className: "code", textContent: completion });
    return [this.#heading(text("done")), note, shown, this.#code(code), element("p", { className: "buttons" }, this.#anew("somebody_else"))];
  }

  withdrawn() { return this.#end("withdrawn"); }

  declined() { return this.#end("declined"); }

  full() { return this.#end("full"); }

  // Their parts.

  #end(key) {
    return [this.#heading(text(key)), element("p", { textContent: text(`${key}_note`) }), element("p", { className: "buttons" }, this.#anew("begin_anew"))];
  }

  #heading(words, lang = "") {
    this.heading = element("h2", { textContent: words, tabIndex: -1, lang });
    return this.heading;
  }

  #code(code) {
    const [before, after] = text("your_code", { code: "\n" }).split("\n");
    return element("p", { className: "note" }, before, element("strong", { textContent: code }), after);
  }

  #button(label, act) {
    const button = element("button", { type: "button", textContent: label });
    button.addEventListener("click", act);
    return button;
  }

  #anew(key) {
    return this.#button(text(key), () => { this.connection.forget(); location.reload(); });
  }

  #form(stage, values) {
    const form = element("form", { autocomplete: "off" });
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.connection.send({ type: "reply", stage, values: values() });
    });
    return form;
  }

  // A text with paragraphs and lists.
  #prose(texts) {
    const lang = languageOf(texts);
    return inLanguage(texts).trim().split(/\n\s*\n/).map((block) => {
      const lines = block.split("\n");
      if (!lines.every((line) => line.startsWith("- "))) return element("p", { textContent: block, lang });
      return element("ul", { lang }, ...lines.map((line) => element("li", { textContent: line.slice(2) })));
    });
  }

  #question(question) {
    const words = inLanguage(question.text), lang = languageOf(question.text), name = `q-${question.id}`;
    const optional = question.required ? [] : [element("span", { className: "note", textContent: ` ${text("optional")}` })];
    if (question.kind === "text") {
      const label = element("label", { htmlFor: name, lang }, words, ...optional);
      return element("p", { className: "question" }, label, element("textarea", { id: name, name, rows: 4, maxLength: 5000, required: question.required }));
    }
    const set = element("fieldset", { className: `question ${question.kind}` }, element("legend", { lang }, words, ...optional));
    const input = (value, required) => element("input", { type: question.kind === "choices" ? "checkbox" : "radio", name, value, required });
    if (question.kind === "scale") {
      const [low, high] = question.options.map((option) => inLanguage(option.text));
      const points = Array.from({ length: question.points }, (_, index) => {
        const end = index === 0 ? low : index === question.points - 1 ? high : null;
        const label = element("label", {}, input(String(index + 1), question.required), ` ${index + 1}`);
        if (end) label.append(element("span", { className: "hidden", textContent: `: ${end}` }));
        return label;
      });
      const side = (words) => element("span", { className: "end", textContent: words, ariaHidden: "true" });
      set.append(element("div", { className: "points" }, side(low), ...points, side(high)));
    } else {
      const required = question.required && question.kind === "choice";
      set.append(...question.options.map((option) => element("label", { lang: languageOf(option.text) }, input(option.id, required), ` ${inLanguage(option.text)}`)));
    }
    return set;
  }

  #filled() {
    const inputs = [...this.sheet.querySelectorAll("input, textarea")];
    return new Map(inputs.map((input) => [`${input.name}=${input.type === "textarea" ? "" : input.value}`, input.type === "textarea" ? input.value : input.checked]));
  }

  #fill(filled) {
    for (const input of this.sheet.querySelectorAll("input, textarea")) {
      const value = filled.get(`${input.name}=${input.type === "textarea" ? "" : input.value}`);
      if (value !== undefined) input[input.type === "textarea" ? "value" : "checked"] = value;
    }
  }
}

function answer(form, question) {
  const name = `q-${question.id}`;
  if (question.kind === "text") return form.elements[name].value;
  const chosen = [...form.querySelectorAll("input:checked")].filter((input) => input.name === name).map((input) => input.value);
  if (question.kind === "choices") return chosen;
  if (!chosen.length) return null;
  return question.kind === "scale" ? Number(chosen[0]) : chosen[0];
}
