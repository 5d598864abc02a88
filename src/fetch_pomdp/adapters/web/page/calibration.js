// From an arm in a picture to a place on the screen: what is measured of the arm, and how it is fitted. No browser
// needed.
//
// Joints are those of MediaPipe Pose: x, y as shares of the picture's width and height, downwards, and visibility.
// Nobody knows where the camera is. The person points at marks whose places on the screen are known, and an affine map
// from the arm to the screen is fitted; its error is what it makes at each mark when it has not seen that mark.

/** @typedef {[x: number, y: number]} Pair */
/** @typedef {"left" | "right"} Side */
/**
 * @typedef {{ hand: Pair, place: Pair }} Sample hand: in shoulder widths from the eyes; place: from -1 to 1 each way
 *   in the picture of the table
 */

export const LARGEST = 0.3; // rad: with a coarser arm the mouse is used
export const SMALLEST = 0.02; // rad: nobody's arm is surer than that, whatever six marks say
const RIDGE = 1e-3;
const SEEN = 0.5; // visibility from which a joint counts
const RAISED = 0.9; // shoulder widths below the shoulders: a hand lower than that rests
/** @type {Record<Side, { shoulder: number, wrist: number, finger: number }>} */
const ARMS = { left: { shoulder: 11, wrist: 15, finger: 19 }, right: { shoulder: 12, wrist: 16, finger: 20 } };
const EYES = [2, 5];

/**
 * What is seen of a person: whether head and shoulders are, which hands are up, and where each hand is, seen from the
 * eyes, in shoulder widths.
 * @param {Joint[] | null} joints
 * @param {number} aspect width over height of the picture
 * @returns {{ person: boolean, raised: Side[], hands: Partial<Record<Side, Pair>> }}
 */
export function arms(joints, aspect) {
  if (!joints) return { person: false, raised: [], hands: {} };
  /** @param {number} index @returns {Place} */
  const at = (index) => ({ x: joints[index].x * aspect, y: joints[index].y, seen: joints[index].visibility >= SEEN });
  const [left, right] = [at(ARMS.left.shoulder), at(ARMS.right.shoulder)],
    eyes = middle(at(EYES[0]), at(EYES[1]));
  const width = Math.hypot(left.x - right.x, left.y - right.y);
  if (!left.seen || !right.seen || !eyes.seen || width < 0.02) return { person: false, raised: [], hands: {} };
  /** @type {Partial<Record<Side, Pair>>} */
  const hands = {};
  /** @type {Side[]} */
  const raised = [];
  for (const side of /** @type {Side[]} */ (["left", "right"])) {
    const { wrist, finger } = ARMS[side],
      hand = middle(at(wrist), at(finger));
    hands[side] = [(hand.x - eyes.x) / width, (hand.y - eyes.y) / width];
    if (at(wrist).seen && (at(wrist).y - (left.y + right.y) / 2) / width < RAISED) raised.push(side);
  }
  return { person: true, raised, hands };
}

/** @typedef {{ x: number, y: number, seen: boolean }} Place */

/** @param {Place} one @param {Place} other @returns {Place} */
function middle(one, other) {
  return { x: (one.x + other.x) / 2, y: (one.y + other.y) / 2, seen: one.seen && other.seen };
}

/** Fit an affine map; return it as a function of a hand. @param {Sample[]} samples @returns {(hand: Pair) => Pair} */
export function fit(samples) {
  const centre = [0, 1].map((axis) => samples.reduce((sum, { hand }) => sum + hand[axis], 0) / samples.length);
  const rows = samples.map(({ hand }) => [1, hand[0] - centre[0], hand[1] - centre[1]]);
  /** @param {number} axis @returns {(hand: Pair) => number} */
  const along = (axis) => {
    const [offset, x, y] = solve(
      [0, 1, 2].map((i) =>
        [0, 1, 2].map((j) => rows.reduce((sum, row) => sum + row[i] * row[j], i === j && i ? RIDGE : 0)),
      ),
      [0, 1, 2].map((i) => rows.reduce((sum, row, index) => sum + row[i] * samples[index].place[axis], 0)),
    );
    return (hand) => offset + x * (hand[0] - centre[0]) + y * (hand[1] - centre[1]);
  };
  const across = along(0),
    down = along(1);
  return (hand) => [across(hand), down(hand)];
}

/**
 * Solve a symmetric positive definite system of three by elimination.
 * @param {number[][]} matrix
 * @param {number[]} right
 */
function solve(matrix, right) {
  const rows = matrix.map((row, index) => [...row, right[index]]);
  for (let pivot = 0; pivot < 3; pivot += 1)
    for (let row = 0; row < 3; row += 1) {
      if (row === pivot) continue;
      const share = rows[row][pivot] / rows[pivot][pivot];
      rows[row] = rows[row].map((value, column) => value - share * rows[pivot][column]);
    }
  return rows.map((row, index) => row[3] / row[index]);
}

/**
 * How well samples can be told from each other. error: root mean square over samples, each judged by the map of the
 * others; guess: the same by the mean of the others, which is what an arm that tells nothing comes to.
 * @param {Sample[]} samples
 * @param {(place: Pair, index: number) => number} angle rad between a place and where sample `index` was
 */
export function judge(samples, angle) {
  /** @param {number} index */
  const rest = (index) => samples.filter((_, other) => other !== index);
  /** @param {Sample[]} others @param {number} axis */
  const mean = (others, axis) => others.reduce((sum, { place }) => sum + place[axis], 0) / others.length;
  /** @param {(others: Sample[], sample: Sample) => Pair} predicted */
  const rms = (predicted) =>
    Math.sqrt(
      samples.reduce((sum, sample, index) => sum + angle(predicted(rest(index), sample), index) ** 2, 0) /
        samples.length,
    );
  return {
    error: rms((others, { hand }) => fit(others)(hand)),
    guess: rms((others) => [mean(others, 0), mean(others, 1)]),
  };
}

/**
 * What the model expects of this arm: its spread (rad), or null where the mouse is better.
 * The model's spread is that of the angle off the item, which is what was judged.
 * @param {{ error: number, guess: number }} judged
 */
export function sigma({ error, guess }) {
  if (!(error <= LARGEST) || error > 0.7 * guess) return null;
  return Math.max(SMALLEST, Math.round(error * 100) / 100);
}

/** Whether a hand rests in the air, and away from where it was taken last. */
export class Stillness {
  /** @type {[time: number, hand: Pair][]} */
  #seen = []; // of the last STILL milliseconds
  /** @type {Pair | null} */
  #last = null;

  static STILL = 1000; // ms
  static LEAST = 4; // pictures, however long they take
  static WIDE = 0.1; // shoulder widths, around the middle
  static AWAY = 0.1; // shoulder widths, from where it was taken last

  /**
   * Take what is seen now; return the place of the hand once it has been still.
   * @param {number} time ms
   * @param {Pair | null} hand null if it is down
   */
  take(time, hand) {
    if (!hand) {
      this.#seen = [];
      this.#last = null;
      return null;
    }
    this.#seen.push([time, hand]);
    while (this.#seen.length > Stillness.LEAST && this.#seen[1][0] <= time - Stillness.STILL) this.#seen.shift();
    if (this.#seen.length < Stillness.LEAST || this.#seen[0][0] > time - Stillness.STILL) return null;
    /** @param {number} axis */
    const along = (axis) => median(this.#seen.map(([, each]) => each[axis]));
    /** @type {Pair} */
    const place = [along(0), along(1)];
    /** @param {Pair} one @param {Pair} other */
    const far = (one, other) => Math.hypot(one[0] - other[0], one[1] - other[1]);
    if (this.#seen.some(([, each]) => far(each, place) > Stillness.WIDE)) return null;
    if (this.#last && far(this.#last, place) < Stillness.AWAY) return null;
    this.#last = place;
    this.#seen = [];
    return place;
  }
}

/** @param {number[]} values */
function median(values) {
  const sorted = [...values].sort((one, other) => one - other);
  return (sorted[Math.floor((sorted.length - 1) / 2)] + sorted[Math.ceil((sorted.length - 1) / 2)]) / 2;
}
