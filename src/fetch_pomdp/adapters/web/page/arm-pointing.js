// Pointing with an arm before the webcam: calibration, what is said of it, and where the arm points then.

import { arms, fit, judge, LARGEST, sigma, Stillness } from "./calibration.js";
import { Camera } from "./camera.js";
import { find, findAll } from "./dom.js";
import { vector } from "./geometry.js";
import { decimal, text } from "./texts.js";

/** @import { Vector3 } from "three" */
/** @import { Pair, Sample, Side } from "./calibration.js" */
/** @import { TableView } from "./table-view.js" */
/** @typedef {(place: Vector3 | null) => void} Place */

const SLOW = 5, QUICK = 6; // pictures a second below which it is said, and above which no more
const GONE = 3000; // ms without a person after which it is said
const HELD = 300; // ms for which an arm must be up, and not on its way, before it points
const FAST = 1.5; // shoulder widths a second: a hand that is as fast is on its way
const HUNG = 1000; // ms without a picture after which an arm no longer points
const OUTSIDE = 1.25; // of the picture's half: an arm that points farther out points at something else
const SPREAD = 0.12; // m, at least, of the marks to each side of the items' middle

export class ArmPointing {
  /** @type {number | null} */
  sigma = null; // rad, of a calibrated arm
  /** @type {Sample[]} */
  #samples = [];
  /** @type {Vector3[] | null} */
  #marks = null; // while calibrating: places on the table
  /** @type {((hand: Pair) => Pair) | null} */
  #map = null;
  /** @type {Side | null} */
  #side = null; // the arm that calibrated
  #still = new Stillness();
  /** @type {string | null} */
  #state = null; // a text's key
  /** @type {Record<string, string | number>} */
  #values = {};
  /** @type {Record<"left" | "top" | "width" | "height", number> | null} */
  #shape = null; // of the picture, when it was calibrated
  /** @type {number | null} */
  #upSince = null;
  #lowered = false; // since the calibration: an arm that was up for that does not point yet
  /** @type {{ now: number, hand: Pair } | null} */
  #before = null; // the hand in the picture before
  #pointing = false;
  #personAt = 0;
  #rate = QUICK;
  /** @type {number | null} */
  #lastAt = null;

  /**
   * @param {TableView | null} view without one, an arm cannot point
   * @param {{ onPoint: Place, onRelease: () => void, onCalibrate: () => void }} listeners called with the place that is pointed
   *   at, when nothing is any more, and when the arm has another spread, `sigma`, with which an interaction is to begin
   */
  constructor(view, listeners) {
    this.view = view;
    this.listeners = listeners;
    this.camera = new Camera(find("#preview", HTMLCanvasElement), (joints, aspect) => this.#saw(joints, aspect), (reason) => this.#failed(reason));
    find("#arm-choice").hidden = !view || !navigator.mediaDevices;
    for (const choice of findAll("[name=pointing]", HTMLInputElement)) choice.addEventListener("change", () => this.#choose(choice.value === "camera"));
    find("#calibrate").addEventListener("click", () => this.#begin());
    find("#camera-off").addEventListener("click", () => this.#off());
    setInterval(() => this.#watch(), HUNG / 2);
  }

  /** Say it again, in a language that was chosen meanwhile. */
  translate() {
    if (this.#state) this.#say(this.#state, this.#values);
    if (find("#camera-slow").textContent) find("#camera-slow").textContent = text("arm_slow");
  }

  /** The table is another one. */
  forget() {
    this.sigma = null;
    if (!this.#map && !this.#marks) return;
    this.#drop();
    this.#say("arm_moved");
  }

  /** Put the ring where the picture has the mark. */
  follow() {
    find("#mark").hidden = !this.#marks;
    if (!this.#marks || !this.view) return;
    const { x, y } = this.view.seen(this.#marks[this.#samples.length]);
    find("#mark").style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }

  /** @param {boolean} camera whether it is to be used, instead of the mouse */
  async #choose(camera) {
    find("#camera").hidden = !camera;
    this.#drop();
    if (camera) {
      this.#say("arm_opening");
      this.#personAt = 0;
      this.#lastAt = null;
      this.#rate = QUICK;
      find("#camera-slow").textContent = "";
      await this.camera.open();
    } else {
      this.camera.close();
      this.#state = this.sigma = null; // from the next interaction on
    }
  }

  #off() {
    const mouse = find("[name=pointing][value=mouse]", HTMLInputElement);
    mouse.checked = true;
    mouse.dispatchEvent(new Event("change"));
    find("#options").focus();
  }

  /** @param {string | null} reason */
  #failed(reason) {
    this.#drop();
    if (reason === null) this.#say("arm_lost");
    else this.#say("arm_denied", { reason });
  }

  /** @param {string} key @param {Record<string, string | number>} values */
  #say(key, values = {}) {
    this.#state = key;
    this.#values = values;
    const line = text(key, values);
    if (find("#camera-state").textContent !== line) find("#camera-state").textContent = line;
    const button = find("#calibrate", HTMLButtonElement);
    button.disabled = !this.camera.on || key === "arm_opening";
    button.textContent = text(this.#marks || this.#map ? "calibrate_again" : "calibrate");
  }

  #drop() {
    this.#marks = this.#map = this.#side = null;
    this.#samples = [];
    this.#end();
    this.follow();
  }

  /** Begin a calibration: marks in two rows of three over the items. */
  #begin() {
    if (!this.view) return;
    this.#drop();
    const { scene, frame: { middle, ahead, right, height } } = this.view.table;
    /** @param {Vector3} axis */
    const reach = (axis) => Math.max(SPREAD, ...scene.items.map((item) => Math.abs(vector(item.position).sub(middle).dot(axis))));
    const [wide, deep] = [reach(right), reach(ahead)];
    this.#marks = [[-1, 1], [0, 1], [1, 1], [1, -1], [0, -1], [-1, -1]].map(([x, y]) => middle.clone().addScaledVector(right, x * wide).addScaledVector(ahead, y * deep).setZ(height));
    this.#shape = this.#canvas();
    this.#still = new Stillness();
    this.#ask(this.#marks);
  }

  /** @param {Vector3[]} marks */
  #ask(marks) {
    this.follow();
    this.#say("arm_point", { number: this.#samples.length + 1, all: marks.length });
  }

  /** @param {TableView} view @param {Vector3[]} marks @param {{ side: Side | null, hand: Pair | null }} raised */
  #calibrate(view, marks, { side, hand }) {
    if (side && this.#side && side !== this.#side) {
      this.#say("arm_other");
      return;
    }
    const taken = this.#still.take(performance.now(), hand);
    if (taken) {
      this.#side = side;
      this.#samples.push({ hand: taken, place: this.#placeOf(view, marks[this.#samples.length]) });
    }
    if (this.#samples.length < marks.length) this.#ask(marks);
    else this.#conclude(view, marks);
  }

  /** @param {TableView} view @param {Vector3[]} marks */
  #conclude(view, marks) {
    const { head } = view.table;
    /** @param {Vector3} place */
    const way = (place) => place.clone().sub(head);
    const judged = judge(this.#samples, (place, index) => {
      const at = this.#tableAt(view, place);
      return at ? way(at).angleTo(way(marks[index])) : Math.PI;
    });
    const found = sigma(judged);
    this.#marks = null;
    this.follow();
    this.#map = found === null ? null : fit(this.#samples);
    this.#lowered = false;
    this.#samples = [];
    const error = decimal(judged.error);
    if (found !== null) this.#say("arm_good", good(found));
    else this.#say(judged.error > LARGEST ? "arm_coarse" : "arm_blind", { error, most: decimal(LARGEST), guess: decimal(judged.guess) });
    const before = this.sigma;
    this.sigma = found;
    if (found !== null && found !== before) this.listeners.onCalibrate();
  }

  // Places in the picture, from -1 to 1 each way, and the table's beneath them.

  #canvas() {
    const { left, top, width, height } = find("#view").getBoundingClientRect();
    return { left, top, width, height };
  }

  /** @param {TableView} view @param {Vector3} point @returns {Pair} */
  #placeOf(view, point) {
    const { x, y } = view.seen(point), { width, height } = this.#canvas();
    return [(2 * x) / width - 1, (2 * y) / height - 1];
  }

  /** @param {TableView} view @param {Pair} place */
  #tableAt(view, [x, y]) {
    const { width, height } = this.#canvas();
    return view.at(((x + 1) / 2) * width, ((y + 1) / 2) * height);
  }

  // What is seen.

  /** @param {Joint[] | null} joints @param {number} aspect */
  #saw(joints, aspect) {
    if (!this.view) return;
    const now = performance.now(), { person, raised, hands } = arms(joints, aspect);
    this.#pace(now);
    if (person || !this.#personAt) this.#personAt = now;
    const side = raised.length === 1 ? raised[0] : null;
    if (raised.length === 2) {
      this.#end();
      this.#say("arm_both");
    } else if (!person && now - this.#personAt > GONE) {
      this.#end();
      this.#say("arm_nobody");
    } else if (this.#marks) this.#calibrate(this.view, this.#marks, { side, hand: side && hands[side] || null });
    else this.#use(this.view, now, side && side === this.#side && hands[side] || null);
  }

  /** @param {number} now ms */
  #pace(now) {
    if (this.#lastAt !== null) this.#rate += 0.1 * (1000 / Math.max(now - this.#lastAt, 1) - this.#rate);
    this.#lastAt = now;
    if (this.#rate > QUICK) find("#camera-slow").textContent = "";
    else if (this.#rate < SLOW) find("#camera-slow").textContent = text("arm_slow");
  }

  /** @param {TableView} view @param {number} now ms @param {Pair | null} hand */
  #use(view, now, hand) {
    if (!this.#map || this.sigma === null) {
      if (!["arm_coarse", "arm_blind", "arm_moved"].includes(this.#state ?? "")) this.#say("arm_begin");
      return;
    }
    if (this.#moved()) {
      this.forget();
      return;
    }
    const place = hand && this.#map(hand), fast = this.#fast(now, hand);
    if (!hand) this.#lowered = true;
    if (!place || fast || !this.#lowered || place.some((part) => Math.abs(part) > OUTSIDE)) this.#end();
    else {
      this.#upSince ??= now;
      this.#pointing = now - this.#upSince >= HELD;
      if (this.#pointing) this.listeners.onPoint(this.#tableAt(view, place));
    }
    this.#say("arm_good", good(this.sigma));
  }

  /** @param {number} now ms @param {Pair | null} hand */
  #fast(now, hand) {
    const before = this.#before;
    this.#before = hand && { now, hand };
    if (!hand || !before) return true;
    return Math.hypot(hand[0] - before.hand[0], hand[1] - before.hand[1]) / (now - before.now) > FAST / 1000;
  }

  /** A picture elsewhere on the screen is pointed at otherwise. */
  #moved() {
    const now = this.#canvas(), before = this.#shape;
    if (!before) return false;
    return /** @type {const} */ (["left", "top", "width", "height"]).some((side) => Math.abs(now[side] - before[side]) > 0.05 * before.width);
  }

  #end() {
    this.#upSince = null;
    if (this.#pointing) this.listeners.onRelease();
    this.#pointing = false;
  }

  /** An arm does not point on while no pictures come. */
  #watch() {
    if (!this.camera.on || this.#lastAt === null || performance.now() - this.#lastAt < HUNG) return;
    this.#rate = 0;
    find("#camera-slow").textContent = text("arm_slow");
    this.#end();
  }
}

/** @param {number} spread rad */
const good = (spread) => ({ error: decimal(spread), degrees: Math.round((spread * 180) / Math.PI) });
