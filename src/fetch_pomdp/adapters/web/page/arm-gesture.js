// What a raised arm does over several pictures: it points at the marks of a calibration, or at the table. No browser
// needed.

import { Stillness } from "./calibration.js";

/** @import { Pair, Sample, Side } from "./calibration.js" */

const HELD = 300; // ms for which an arm must be up, and not on its way, before it points
const FAST = 1.5; // shoulder widths a second: a hand that is as fast is on its way
const OUTSIDE = 1.25; // of the picture's half: an arm that points farther out points at something else

/** Marks that are pointed at one after the other, with the arm that began, and held still. */
export class MarkedSamples {
  /** @type {Sample[]} */
  samples = [];
  /** @type {Side | null} */
  side = null;
  #still = new Stillness();

  /** @param {number} count of the marks */
  constructor(count) {
    this.count = count;
  }

  /** Whether every mark was pointed at. */
  get done() {
    return this.samples.length === this.count;
  }

  /**
   * Take what is seen now; false for the other arm.
   * @param {number} now ms
   * @param {{ side: Side | null, hand: Pair | null }} raised
   * @param {(mark: number) => Pair} placeOf where a mark is in the picture of the table
   */
  take(now, { side, hand }, placeOf) {
    if (side && this.side && side !== this.side) return false;
    const taken = this.#still.take(now, hand);
    if (taken) {
      this.side = side;
      this.samples.push({ hand: taken, place: placeOf(this.samples.length) });
    }
    return true;
  }
}

/** Whether a calibrated arm points. One that is still up from the calibration does not, before it was lowered. */
export class RaisedArm {
  #lowered = false;
  /** @type {number | null} */
  #upSince = null;
  /** @type {{ now: number, hand: Pair } | null} */
  #before = null; // the hand in the picture before

  /**
   * Take what is seen now; true while it points.
   * @param {number} now ms
   * @param {Pair | null} hand
   * @param {Pair | null} place in the picture of the table
   */
  points(now, hand, place) {
    const fast = this.#fast(now, hand);
    if (!hand) this.#lowered = true;
    if (!place || fast || !this.#lowered || place.some((part) => Math.abs(part) > OUTSIDE)) {
      this.end();
      return false;
    }
    this.#upSince ??= now;
    return now - this.#upSince >= HELD;
  }

  /** It points no longer, whatever is seen. */
  end() {
    this.#upSince = null;
  }

  /** @param {number} now ms @param {Pair | null} hand */
  #fast(now, hand) {
    const before = this.#before;
    this.#before = hand && { now, hand };
    if (!hand || !before) return true;
    return Math.hypot(hand[0] - before.hand[0], hand[1] - before.hand[1]) / (now - before.now) > FAST / 1000;
  }
}
