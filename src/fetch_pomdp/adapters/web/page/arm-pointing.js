// Pointing with an arm before the webcam: calibration, what is said of it, and where the arm points then.

import { MarkedSamples, RaisedArm } from "./arm-gesture.js";
import { arms, fit, judge, LARGEST, sigma } from "./calibration.js";
import { Camera } from "./camera.js";
import { find, findAll } from "./dom.js";
import { vector } from "./geometry.js";
import { decimal, text } from "./texts.js";

/** @import { Vector3 } from "three" */
/** @import { Pair, Side } from "./calibration.js" */
/** @import { TableView } from "./table-view.js" */
/** @typedef {Record<"left" | "top" | "width" | "height", number>} Rectangle in pixels */
/**
 * @typedef {{ marks: Vector3[], taken: MarkedSamples, shape: Rectangle }} Calibration that goes on; shape: of the
 *   picture of the table
 */
/** @typedef {{ map: (hand: Pair) => Pair, side: Side | null, shape: Rectangle, gesture: RaisedArm }} CalibratedArm */

const SLOW = 5,
  QUICK = 6; // pictures a second below which it is said, and above which no more
const GONE = 3000; // ms without a person after which it is said
const HUNG = 1000; // ms without a picture after which an arm no longer points
const SPREAD = 0.12; // m, at least, of the marks to each side of the items' middle

export class ArmPointing {
  /** @type {number | null} */
  sigma = null; // rad, of a calibrated arm
  /** @type {Calibration | null} */
  #calibration = null;
  /** @type {CalibratedArm | null} */
  #arm = null;
  /** @type {{ key: string, values: Record<string, string | number> } | null} */
  #said = null;
  #pointing = false;
  #personAt = 0;
  #rate = QUICK;
  /** @type {number | null} */
  #lastAt = null;

  /**
   * @param {TableView | null} view without one, an arm cannot point
   * @param {object} listeners
   * @param {(place: Vector3 | null) => void} listeners.onPoint called with the place that is pointed at
   * @param {() => void} listeners.onRelease called when nothing is pointed at any more
   * @param {() => void} listeners.onCalibrate called when the arm has another spread, with which
   *   an interaction is to begin
   */
  constructor(view, listeners) {
    this.view = view;
    this.listeners = listeners;
    this.camera = new Camera(
      find("#preview", HTMLCanvasElement),
      (joints, aspect) => this.#saw(joints, aspect),
      (reason) => this.#failed(reason),
    );
    find("#arm-choice").hidden = !view || !navigator.mediaDevices;
    for (const choice of findAll("[name=pointing]", HTMLInputElement))
      choice.addEventListener("change", () => this.#choose(choice.value === "camera"));
    find("#calibrate").addEventListener("click", () => this.#begin());
    find("#camera-off").addEventListener("click", () => this.#off());
    setInterval(() => this.#watch(), HUNG / 2);
  }

  /** Say it again, in a language that was chosen meanwhile. */
  translate() {
    if (this.#said) this.#say(this.#said.key, this.#said.values);
    if (find("#camera-slow").textContent) find("#camera-slow").textContent = text("arm_slow");
  }

  /** The table is another one. */
  forget() {
    this.sigma = null;
    if (!this.#arm && !this.#calibration) return;
    this.#drop();
    this.#say("arm_moved");
  }

  /** Put the ring where the picture has the mark. */
  follow() {
    const mark = find("#mark");
    mark.hidden = !this.#calibration;
    if (!this.#calibration || !this.view) return;
    const { marks, taken } = this.#calibration,
      { x, y } = this.view.seen(marks[taken.samples.length]);
    mark.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
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
      this.#said = this.sigma = null; // from the next interaction on
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
    this.#said = { key, values };
    const line = text(key, values);
    if (find("#camera-state").textContent !== line) find("#camera-state").textContent = line;
    const button = find("#calibrate", HTMLButtonElement);
    button.disabled = !this.camera.on || key === "arm_opening";
    button.textContent = text(this.#calibration || this.#arm ? "calibrate_again" : "calibrate");
  }

  #drop() {
    this.#calibration = this.#arm = null;
    this.#end();
    this.follow();
  }

  /** Begin a calibration: marks in two rows of three over the items. */
  #begin() {
    if (!this.view) return;
    this.#drop();
    const {
      scene,
      frame: { middle, ahead, right, height },
    } = this.view.table;
    /** @param {Vector3} axis */
    const reach = (axis) =>
      Math.max(SPREAD, ...scene.items.map((item) => Math.abs(vector(item.position).sub(middle).dot(axis))));
    const [wide, deep] = [reach(right), reach(ahead)];
    const places = [
      [-1, 1],
      [0, 1],
      [1, 1],
      [1, -1],
      [0, -1],
      [-1, -1],
    ];
    const marks = places.map(([x, y]) =>
      middle
        .clone()
        .addScaledVector(right, x * wide)
        .addScaledVector(ahead, y * deep)
        .setZ(height),
    );
    this.#calibration = { marks, taken: new MarkedSamples(marks.length), shape: this.#canvas() };
    this.#ask(this.#calibration);
  }

  /** @param {Calibration} calibration */
  #ask({ marks, taken }) {
    this.follow();
    this.#say("arm_point", { number: taken.samples.length + 1, all: marks.length });
  }

  /**
   * @param {TableView} view
   * @param {Calibration} calibration
   * @param {{ side: Side | null, hand: Pair | null }} raised
   */
  #calibrate(view, calibration, raised) {
    const { marks, taken } = calibration;
    if (!taken.take(performance.now(), raised, (mark) => this.#placeOf(view, marks[mark]))) this.#say("arm_other");
    else if (taken.done) this.#conclude(view, calibration);
    else this.#ask(calibration);
  }

  /** @param {TableView} view @param {Calibration} calibration */
  #conclude(view, { marks, taken: { samples, side }, shape }) {
    const { head } = view.table;
    /** @param {Vector3} place */
    const way = (place) => place.clone().sub(head);
    const judged = judge(samples, (place, index) => {
      const at = this.#tableAt(view, place);
      return at ? way(at).angleTo(way(marks[index])) : Math.PI;
    });
    const found = sigma(judged),
      before = this.sigma;
    this.#calibration = null;
    this.follow();
    this.#arm = found === null ? null : { map: fit(samples), side, shape, gesture: new RaisedArm() };
    this.sigma = found;
    if (found !== null) this.#say("arm_good", good(found));
    else
      this.#say(judged.error > LARGEST ? "arm_coarse" : "arm_blind", {
        error: decimal(judged.error),
        most: decimal(LARGEST),
        guess: decimal(judged.guess),
      });
    if (found !== null && found !== before) this.listeners.onCalibrate();
  }

  // Places in the picture, from -1 to 1 each way, and the table's beneath them.

  #canvas() {
    const { left, top, width, height } = find("#view").getBoundingClientRect();
    return { left, top, width, height };
  }

  /** @param {TableView} view @param {Vector3} point @returns {Pair} */
  #placeOf(view, point) {
    const { x, y } = view.seen(point),
      { width, height } = this.#canvas();
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
    const now = performance.now(),
      { person, raised, hands } = arms(joints, aspect);
    this.#pace(now);
    if (person || !this.#personAt) this.#personAt = now;
    const side = raised.length === 1 ? raised[0] : null;
    if (raised.length === 2) {
      this.#end();
      this.#say("arm_both");
    } else if (!person && now - this.#personAt > GONE) {
      this.#end();
      this.#say("arm_nobody");
    } else if (this.#calibration)
      this.#calibrate(this.view, this.#calibration, { side, hand: (side && hands[side]) ?? null });
    else this.#use(this.view, now, (side && side === this.#arm?.side && hands[side]) || null);
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
    if (!this.#arm || this.sigma === null) {
      if (!["arm_coarse", "arm_blind", "arm_moved"].includes(this.#said?.key ?? "")) this.#say("arm_begin");
      return;
    }
    if (this.#moved(this.#arm.shape)) {
      this.forget();
      return;
    }
    const place = hand && this.#arm.map(hand);
    if (!this.#arm.gesture.points(now, hand, place) || !place) this.#release();
    else {
      this.#pointing = true;
      this.listeners.onPoint(this.#tableAt(view, place));
    }
    this.#say("arm_good", good(this.sigma));
  }

  /** A picture elsewhere on the screen is pointed at otherwise. @param {Rectangle} before */
  #moved(before) {
    const now = this.#canvas();
    return /** @type {const} */ (["left", "top", "width", "height"]).some(
      (side) => Math.abs(now[side] - before[side]) > 0.05 * before.width,
    );
  }

  #end() {
    this.#arm?.gesture.end();
    this.#release();
  }

  #release() {
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
