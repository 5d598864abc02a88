import assert from "node:assert/strict";
import { test } from "node:test";
import { item, scene, TWINS } from "./scenes.js";
import { TableDraft } from "#page/table-draft.js";

/** @param {import("#page/messages.js").Scene} table */
function draft(table = TWINS) {
  const made = new TableDraft();
  made.load(table);
  return made;
}

test("a table becomes a scene file", () => {
  const made = draft(scene(item("cup", [0.12345, 1, 0.75])));
  made.items[0].words = "cup, red  small,";
  assert.equal(
    made.toml(),
    [
      "head = [0.0, 0.0, 1.6]  # m, of the person",
      "",
      "[[items]]",
      'id = "cup"',
      "position = [0.123, 1.0, 0.75]  # m",
      'vocabulary = ["cup", "red", "small"]',
      "",
    ].join("\n"),
  );
});

test("what is typed cannot leave its quotes", () => {
  const made = draft(scene(item("cup", [0, 1, 0.75])));
  made.items[0].id = 'a"\n[model]';
  assert.ok(made.toml().includes('id = "a\\"\\n[model]"'));
});

test("a coordinate that is no number is told as such", () => {
  const made = draft(scene(item("cup", [0, 1, 0.75])));
  made.items[0].position[1] = Number.NaN;
  assert.ok(made.toml().includes("position = [0.0, nan, 0.75]"));
});

test("editing leaves the scene as it was", () => {
  const made = draft();
  made.move(made.items[0], 5, 5);
  assert.deepEqual(TWINS.items[0].position, [-0.4, 2, 0.75]);
  assert.deepEqual(made.items[0].position, [5, 5, 0.75]);
});

test("the nearest item within reach is grabbed, and none farther away", () => {
  const made = draft();
  assert.equal(made.nearest(0.12, 2.02)?.id, "marker-2");
  assert.equal(made.nearest(-0.03, 2)?.id, "marker-1");
  assert.equal(made.nearest(0.5, 2), null);
  assert.equal(new TableDraft().nearest(0, 0), null);
});

test("places are rounded to millimetres", () => {
  const made = draft();
  made.move(made.items[1], 0.12349, -0.00051);
  assert.deepEqual(made.items[1].position, [0.123, -0.001, 0.75]);
});

test("an item is added beside the last, and removed", () => {
  const made = draft();
  made.add();
  assert.equal(made.items.length, 4);
  assert.deepEqual(made.items[3].position, [0.35, 2, 0.75]);
  made.remove(made.items[0]);
  assert.deepEqual(
    made.items.map(({ id }) => id),
    ["marker-1", "marker-2", "item-4"],
  );
});
