// The page's texts, in the language that was chosen: one file, texts.json.

/** @import { Phrase, PhraseValue, Texts } from "./messages.js" */

/** @type {Record<string, Record<string, string>>} */
const all = await (await fetch("texts.json")).json();
let language = "en";

export function preferredLanguage() {
  const wanted = localStorage.getItem("language") ?? navigator.language.slice(0, 2);
  return wanted in all ? wanted : "en";
}

/** @param {string} name */
export function setLanguage(name) {
  language = name;
  localStorage.setItem("language", name);
  document.documentElement.lang = name;
  for (const element of attributed("data-text")) element.textContent = text(element.dataset.text ?? "");
  for (const element of attributed("data-label")) element.setAttribute("aria-label", text(element.dataset.label ?? ""));
  for (const element of attributed("data-placeholder"))
    element.setAttribute("placeholder", text(element.dataset.placeholder ?? ""));
}

/** @param {string} name @returns {NodeListOf<HTMLElement>} */
const attributed = (name) => document.querySelectorAll(`[${name}]`);

export function currentLanguage() {
  return language;
}

/** @typedef {Record<string, string | number>} Values for what a text has in braces */

/** The text of a key. @param {string} key @param {Values} values */
export function text(key, values = {}) {
  return filledIn(all[language][key], values);
}

/** @param {string} line @param {Values} values */
const filledIn = (line, values) => line.replace(/\{(\w+)\}/g, (_, name) => String(values[name]));

/** The text of a key in English, whatever the page's language. @param {string} key @param {Values} values */
export function english(key, values = {}) {
  return filledIn(all.en[key], values);
}

export function isEnglish() {
  return language === "en";
}

/** @param {Texts} texts */
export const inLanguage = (texts) => texts[language] ?? texts.en;

/** The language that `inLanguage` fell back to, or "" for the page's own. @param {Texts} texts */
export const fallbackLanguage = (texts) => (language in texts ? "" : "en");

/**
 * A sentence of the server: a value is an item's id, a number as English writes it, or a phrase itself.
 * @param {Phrase} phrase
 * @returns {string}
 */
export function phrase({ key, values }) {
  return text(key, Object.fromEntries(Object.entries(values).map(([name, value]) => [name, filled(value)])));
}

/** @param {PhraseValue} value */
function filled(value) {
  if (typeof value === "string") return value;
  return "number" in value ? localised(value.number) : phrase(value);
}

/** "1,234.5%" with the marks of the page's language. @param {string} number */
function localised(number) {
  const parts = new Intl.NumberFormat(language, { style: "percent", minimumFractionDigits: 1 }).formatToParts(1234.5);
  /** @param {string} type */
  const mark = (type) => parts.find((part) => part.type === type)?.value ?? "";
  /** @type {Record<string, string>} */
  const marks = { ",": mark("group"), ".": mark("decimal"), "%": mark("literal") + mark("percentSign"), "-": "−" };
  return number.replace(/[,.%-]/g, (each) => marks[each]);
}

/** @param {number} share */
export function percent(share) {
  return new Intl.NumberFormat(language, { style: "percent" }).format(share);
}

/** @param {number} number */
export function decimal(number) {
  return new Intl.NumberFormat(language, { minimumFractionDigits: 2, maximumFractionDigits: 2 })
    .format(number)
    .replace("-", "−");
}

/** @param {string[]} list */
export function join(list) {
  return new Intl.ListFormat(language).format(list);
}
