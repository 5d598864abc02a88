import assert from "node:assert/strict";
import { afterEach, beforeEach, mock, test } from "node:test";
import { open } from "./browser.js";
import { TWINS } from "./scenes.js";
import { setLanguage } from "#page/texts.js";
import { canWithdraw, isTrial, Trial } from "#page/trial.js";

/** @import { Stage, TrialStage } from "#page/messages.js" */

/** @type {TrialStage} */
const STAGE = {
  type: "stage",
  stage: "trials",
  title: { en: "Fetching" },
  order: 1,
  of: 9,
  desired: "marker-2",
  running: false,
  give_up: 60,
};

beforeEach(() => {
  open();
  setLanguage("en");
  mock.timers.enable({ apis: ["setTimeout", "setInterval"] });
});
afterEach(() => mock.timers.reset());

function trial(changes = {}) {
  const made = new Trial({ ...STAGE, ...changes });
  made.scene = TWINS;
  return made;
}

test("practice and trials are trials, all else is pages; what is over cannot be withdrawn from", () => {
  /** @param {string} stage */
  const of = (stage) => /** @type {Stage} */ (/** @type {unknown} */ ({ ...STAGE, stage }));
  const stages = [
    "consent",
    "instructions",
    "practice",
    "trials",
    "questions",
    "done",
    "withdrawn",
    "declined",
    "full",
  ];
  assert.deepEqual(
    stages.filter((stage) => isTrial(of(stage))),
    ["practice", "trials"],
  );
  assert.deepEqual(
    stages.filter((stage) => !canWithdraw(of(stage))),
    ["withdrawn", "declined", "full"],
  );
});

test("a trial says which it is and what to get, in words", () => {
  assert.equal(trial().title, "Round 2 of 9");
  assert.equal(trial({ stage: "practice", order: 0, of: 2 }).title, "Practice 1 of 2");
  assert.equal(trial().task, "Get the marker on the right");
  setLanguage("de");
  assert.equal(trial().task, "Zu holen: „marker“ rechts");
});

test("a question is about what the robot points at; a wait changes nothing of that", () => {
  const made = trial();
  made.decide({ action: "point", item: "marker-1" });
  made.decide({ action: "wait", item: null });
  assert.equal(made.question, "The robot points at the marker on the left: “This one?”");
});

test("it ends with what was brought, or with nothing", () => {
  assert.equal(trial().outcome("bowl-1"), "The robot brings you the bowl.");
  assert.equal(trial().outcome(null), "The robot brings you nothing.");
});

test("an item that is not on the table is no item", () => {
  assert.throws(() => trial().outcome("teapot"), RangeError);
});

test("the countdown counts whole seconds, and stops when the interaction begins", () => {
  /** @type {number[]} */
  const counted = [];
  const made = trial();
  made.countDown(3, (left) => counted.push(left));
  mock.timers.tick(2_000);
  assert.deepEqual(counted, [3, 2, 1]);
  mock.timers.tick(5_000);
  assert.deepEqual(counted, [3, 2, 1]);
  const other = trial();
  other.countDown(3, (left) => counted.push(left));
  other.begin(0, () => {});
  mock.timers.tick(5_000);
  assert.deepEqual(counted, [3, 2, 1, 3]);
});

test("it may be given up after a while on the trial's own clock, unless it is over", () => {
  let offered = 0;
  trial().begin(20, () => {
    offered += 1;
  });
  mock.timers.tick(39_999);
  assert.equal(offered, 0);
  mock.timers.tick(1);
  assert.equal(offered, 1);
  const over = trial();
  over.begin(0, () => {
    offered += 1;
  });
  over.end();
  mock.timers.tick(120_000);
  assert.equal(offered, 1);
});
