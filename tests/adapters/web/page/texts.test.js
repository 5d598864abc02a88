import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { beforeEach, test } from "node:test";
import { open, PAGE, TEXTS } from "./browser.js";
import {
  decimal,
  fallbackLanguage,
  inLanguage,
  join,
  percent,
  phrase,
  preferredLanguage,
  setLanguage,
  text,
} from "#page/texts.js";

beforeEach(() => open());

/** @param {string} template */
const holes = (template) => [...template.matchAll(/\{(\w+)\}/g)].map((found) => found[1]).sort();

test("all languages have the same keys", () => {
  for (const texts of Object.values(TEXTS)) assert.deepEqual(Object.keys(texts), Object.keys(TEXTS.en));
});

test("all languages have the same placeholders", () => {
  for (const texts of Object.values(TEXTS))
    for (const [key, template] of Object.entries(texts))
      // English has a pronoun for the item.
      if (key !== "why_it") assert.deepEqual(holes(template), holes(TEXTS.en[key]), key);
});

test("every text that the page asks for by name exists, and every one that exists is asked for", () => {
  const sources = readdirSync(PAGE)
    .filter((name) => /\.(js|html)$/.test(name))
    .map((name) => readFileSync(new URL(name, PAGE), "utf8"));
  const asked = sources.flatMap((source) =>
    [...source.matchAll(/(?:\btext|english)\("(\w+)"|data-(?:text|label|placeholder)="(\w+)"/g)].map(
      (found) => found[1] ?? found[2],
    ),
  );
  assert.deepEqual(
    asked.filter((key) => !(key in TEXTS.en)),
    [],
  );
  // Keys that are put together, or come from the server: a phrase's, what the robot says, and states.
  const composed = /^(why|item|sensor|state|stage|arm)_|_note$/,
    elsewhere = sources.join("\n");
  const said = ["asks", "hands_over", "listening", "failed", "objected", "cancelled", "asking_again", "not_understood"];
  const server = [...said, "connecting", "lost", "busy", "moved"];
  assert.deepEqual(
    Object.keys(TEXTS.en).filter(
      (key) => !composed.test(key) && !server.includes(key) && !elsewhere.includes(`"${key}"`),
    ),
    [],
  );
});

test("placeholders are filled", () => {
  assert.equal(text("got", { item: "cup" }), "You got cup.");
  assert.equal(text("round", { round: 2, of: 9 }), "Round 2 of 9");
});

test("the language is the one chosen before, else the browser's, else English", () => {
  assert.equal(preferredLanguage(), "en");
  Object.assign(navigator, { language: "de-CH" });
  assert.equal(preferredLanguage(), "de");
  Object.assign(navigator, { language: "fr" });
  assert.equal(preferredLanguage(), "en");
  setLanguage("de");
  assert.equal(preferredLanguage(), "de");
});

test("numbers and lists are written as the language does", () => {
  setLanguage("de");
  assert.deepEqual([decimal(-1234.5), percent(0.25), join(["a", "b", "c"])], ["−1.234,50", "25\u00a0%", "a, b und c"]);
  setLanguage("en");
  assert.deepEqual([decimal(-1234.5), percent(0.25), join(["a", "b"])], ["−1,234.50", "25%", "a and b"]);
});

test("a study's text that is not in the page's language is English, and said to be", () => {
  setLanguage("de");
  assert.deepEqual([inLanguage({ en: "Yes" }), fallbackLanguage({ en: "Yes" })], ["Yes", "en"]);
  assert.deepEqual([inLanguage({ en: "Yes", de: "Ja" }), fallbackLanguage({ en: "Yes", de: "Ja" })], ["Ja", ""]);
});

test("a phrase of the server is filled in the page's language, its numbers too", () => {
  const other = {
    key: "why_times",
    values: { likelier: { key: "why_it", values: { item: "cup-1" } }, ratio: { number: "2.5" }, other: "cup-2" },
  };
  setLanguage("en");
  assert.equal(phrase(other), "it is 2.5 times as likely as cup-2");
  setLanguage("de");
  assert.equal(phrase(other), "cup-1 ist 2,5-mal so wahrscheinlich wie cup-2");
  assert.equal(phrase({ key: "why_over", values: { number: { number: "-1,000.5%" } } }), "über −1.000,5\u00a0%");
});
