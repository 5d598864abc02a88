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

export function join(list) {
  return new Intl.ListFormat(language).format(list);
}
