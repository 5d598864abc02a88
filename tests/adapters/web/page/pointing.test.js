import assert from "node:assert/strict";
import { afterEach, beforeEach, mock, test } from "node:test";
import { TWINS } from "./scenes.js";
import { Pointing } from "#page/pointing.js";
import { Vector3 } from "#page/vendor/three.module.min.js";

/** @import { PageMessage } from "#page/messages.js" */

beforeEach(() => mock.timers.enable({ apis: ["setTimeout", "setInterval"] }));
afterEach(() => mock.timers.reset());

function pointing() {
  /** @type {PageMessage[]} */
  const sent = [];
  /** @type {(Vector3 | null)[]} */
  const shown = [];
  const made = new Pointing({ send: (message) => sent.push(message) }, (target) => shown.push(target));
  made.scene = TWINS;
  return { made, sent, shown };
}

test("rays are sent at once and twelve a second, until pointing ends", () => {
  const { made, sent, shown } = pointing();
  made.at(new Vector3(0, 2, 0.75));
  assert.equal(sent.length, 1);
  mock.timers.tick(800);
  assert.equal(sent.length, 11);
  made.end();
  mock.timers.tick(800);
  assert.equal(sent.length, 11);
  assert.equal(shown.at(-1), null);
  assert.equal(made.on, false);
});

test("a target that moves changes the next ray, and adds none", () => {
  const { made, sent } = pointing();
  made.at(new Vector3(0, 2, 0.75));
  made.at(new Vector3(1, 2, 0.75));
  assert.equal(sent.length, 1);
  mock.timers.tick(80);
  assert.ok("wrist" in sent[1] && sent[1].wrist[0] > 0);
});

test("an item's button points for a moment; an unknown one and no place do not", () => {
  const { made, sent } = pointing();
  made.atItem("nothing");
  made.at(null);
  assert.equal(made.on, false);
  made.atItem("marker-1");
  assert.equal(made.on, true);
  mock.timers.tick(1200);
  assert.equal(made.on, false);
  assert.ok(sent.length >= 15);
});
