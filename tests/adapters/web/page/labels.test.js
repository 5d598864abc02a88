import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { open } from "./browser.js";
import { item, scene, TWINS } from "./scenes.js";
import { described, kind } from "#page/labels.js";
import { setLanguage } from "#page/texts.js";

beforeEach(() => {
  open();
  setLanguage("en");
});

/** @param {import("#page/messages.js").Scene} table */
const all = (table) => table.items.map((each) => described(each, table));

test("the kind of an item is its id without its number", () => {
  /** @param {string} id */
  const of = (id) => kind(item(id, [0, 1, 0.7]));
  assert.deepEqual(["marker-1", "cup 12", "tea_3", "pot", "7"].map(of), ["marker", "cup", "tea", "pot", "7"]);
});

test("twins are told apart by left and right, an only one by its kind", () => {
  assert.deepEqual(all(TWINS), ["the bowl", "the marker on the left", "the marker on the right"]);
});

test("twins behind each other are told apart by near and far", () => {
  assert.deepEqual(all(scene(item("cup-1", [0, 3, 0.7]), item("cup-2", [0.1, 2, 0.7]))), [
    "the farther cup",
    "the nearer cup",
  ]);
});

test("more than two are counted from the left, or from the front", () => {
  const row = scene(item("cup-1", [0.4, 2, 0.7]), item("cup-2", [-0.4, 2, 0.7]), item("cup-3", [0, 2, 0.7]));
  assert.deepEqual(all(row), ["cup 3 of 3 from the left", "cup 1 of 3 from the left", "cup 2 of 3 from the left"]);
  const file = scene(item("cup-1", [0, 2, 0.7]), item("cup-2", [0, 3, 0.7]), item("cup-3", [0, 2.5, 0.7]));
  assert.deepEqual(all(file), ["cup 1 of 3 from the front", "cup 3 of 3 from the front", "cup 2 of 3 from the front"]);
});

test("left and right are the person's, wherever they stand", () => {
  const seenFromBehind = { ...TWINS, head: /** @type {[number, number, number]} */ ([0, 4, 1.6]) };
  assert.deepEqual(all(seenFromBehind), ["the bowl", "the marker on the right", "the marker on the left"]);
});
