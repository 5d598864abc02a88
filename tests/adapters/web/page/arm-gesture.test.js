import assert from "node:assert/strict";
import { test } from "node:test";
import { MarkedSamples, RaisedArm } from "#page/arm-gesture.js";

/** @import { Pair, Side } from "#page/calibration.js" */

/**
 * Hold a hand still for so many milliseconds, a picture each 100.
 * @param {MarkedSamples} marks
 * @param {Side} side
 * @param {Pair} hand
 * @param {number} from
 */
function hold(marks, side, hand, from) {
  for (let now = from; now <= from + 1000; now += 100)
    assert.equal(
      marks.take(now, { side, hand }, (mark) => [mark, 0]),
      true,
    );
}

test("each mark is taken once, in their order, when the hand was still", () => {
  const marks = new MarkedSamples(2);
  hold(marks, "right", [0.2, 0.3], 0);
  assert.equal(marks.done, false);
  hold(marks, "right", [0.2, 0.3], 1100); // it has not left the first mark
  assert.equal(marks.samples.length, 1);
  hold(marks, "right", [0.7, 0.3], 3000);
  assert.equal(marks.done, true);
  assert.deepEqual(marks.samples, [
    { hand: [0.2, 0.3], place: [0, 0] },
    { hand: [0.7, 0.3], place: [1, 0] },
  ]);
  assert.equal(marks.side, "right");
});

test("the other arm is not taken once one has begun", () => {
  const marks = new MarkedSamples(2);
  hold(marks, "left", [0.2, 0.3], 0);
  assert.equal(
    marks.take(2000, { side: "right", hand: [0.9, 0.3] }, () => [0, 0]),
    false,
  );
  assert.equal(
    marks.take(2100, { side: null, hand: null }, () => [0, 0]),
    true,
  );
});

/** @type {Pair} */
const PLACE = [0.1, 0.1];

/** What an arm does that was lowered at 0 and is held up from 100 ms on. @param {RaisedArm} arm */
const raised = (arm, pictures = 6) => {
  arm.points(0, null, null);
  return Array.from({ length: pictures }, (_, index) => arm.points(100 * (index + 1), [0.5, 0.5], PLACE));
};

test("a raised arm points after it has been slow for three tenths of a second", () => {
  // The first picture tells no speed: from the second on it is slow, from the fifth on for long enough.
  assert.deepEqual(raised(new RaisedArm()), [false, false, false, false, true, true]);
});

test("an arm that is still up from its calibration does not point before it was lowered", () => {
  const arm = new RaisedArm();
  for (let now = 0; now < 2000; now += 100) assert.equal(arm.points(now, [0.5, 0.5], PLACE), false);
  assert.equal(raised(arm).at(-1), true);
});

test("a hand that is on its way, down or far outside the picture ends it, and it begins anew", () => {
  for (const [hand, place] of /** @type {[Pair | null, Pair | null][]} */ ([
    [[0.9, 0.5], PLACE],
    [null, null],
    [
      [0.5, 0.5],
      [1.3, 0],
    ],
  ])) {
    const arm = new RaisedArm();
    raised(arm);
    assert.equal(arm.points(700, hand, place), false);
    assert.equal(arm.points(800, [0.5, 0.5], PLACE), false);
  }
});

test("what ends it from outside lets it begin anew", () => {
  const arm = new RaisedArm();
  raised(arm);
  arm.end();
  assert.equal(arm.points(700, [0.5, 0.5], PLACE), false);
  assert.equal(arm.points(1000, [0.5, 0.5], PLACE), true);
});
