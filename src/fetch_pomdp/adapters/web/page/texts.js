// The page's texts, in the language that was chosen: one file, texts.json.

const all = await (await fetch("texts.json")).json();
let language = "en";

export function chosenLanguage() {
  const wanted = localStorage.getItem("language") ?? navigator.language.slice(0, 2);
  return wanted in all ? wanted : "en";
}

export function setLanguage(name) {
  language = name;
  localStorage.setItem("language", name);
  document.documentElement.lang = name;
  for (const element of document.querySelectorAll("[data-text]")) element.textContent = text(element.dataset.text);
  for (const element of document.querySelectorAll("[data-label]")) element.setAttribute("aria-label", text(element.dataset.label));
  for (const element of document.querySelectorAll("[data-placeholder]")) element.placeholder = text(element.dataset.placeholder);
}

export function currentLanguage() {
  return language;
}

export function text(key, values = {}) {
  return all[language][key].replace(/\{(\w+)\}/g, (_, name) => values[name]);
}

export function english(key) {
  return all.en[key];
}

export function isEnglish() {
  return language === "en";
}

export function percent(share) {
  return new Intl.NumberFormat(language, { style: "percent" }).format(share);
}

export function decimal(number) {
  return new Intl.NumberFormat(language, { minimumFractionDigits: 2, maximumFractionDigits: 2 }).format(number).replace("-", "−");
}

// A sentence of the server, {key, values}, in the page's language. A value is an item's id, a number as English writes it,
// or a phrase itself.
export function phrase({ key, values }) {
  return text(key, Object.fromEntries(Object.entries(values).map(([name, value]) => [name, filled(value)])));
}

function filled(value) {
  if (typeof value === "string") return value;
  return "number" in value ? localised(value.number) : phrase(value);
}

// "1,234.5%" with the marks of the page's language.
function localised(number) {
  const parts = new Intl.NumberFormat(language, { style: "percent", minimumFractionDigits: 1 }).formatToParts(1234.5);
  const mark = (type) => parts.find((part) => part.type === type).value;
  const space = parts.find((part) => part.type === "literal")?.value ?? "";
  const marks = { ",": mark("group"), ".": mark("decimal"), "%": space + mark("percentSign"), "-": "−" };
  return number.replace(/[,.%-]/g, (each) => marks[each]);
}

export function join(list) {
  return new Intl.ListFormat(language).format(list);
}
