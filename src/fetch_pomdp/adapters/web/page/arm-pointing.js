// Pointing with an arm before the webcam: calibration, what is said of it, and where the arm points then.

import { arms, fit, judge, LARGEST, sigma, Stillness } from "./calibration.js";
import { Camera } from "./camera.js";
import { vector } from "./geometry.js";
import { decimal, text } from "./texts.js";

const $ = (selector) => document.querySelector(selector);
const SLOW = 5, QUICK = 6; // pictures a second below which it is said, and above which no more
const GONE = 3000; // ms without a person after which it is said
const HELD = 300; // ms for which an arm must be up, and not on its way, before it points
const FAST = 1.5; // shoulder widths a second: a hand that is as fast is on its way
const HUNG = 1000; // ms without a picture after which an arm no longer points
const OUTSIDE = 1.25; // of the picture's half: an arm that points farther out points at something else
const SPREAD = 0.12; // m, at least, of the marks to each side of the items' middle

export class Arm {
  #samples = [];
  #marks = null; // while calibrating: places on the table (Vector3)
  #map = null;
  #side = null; // the arm that calibrated
  #still = null;
  #state = null;
  #values = {};
  #shape = null; // of the picture, when it was calibrated
  #upSince = null;
  #lowered = false; // since the calibration: an arm that was up for that does not point yet
  #before = null; // time and place of the hand in the picture before
  #personAt = 0;
  #rate = QUICK;
  #lastAt = null;

  // point: called with the place that is pointed at; release: when nothing is any more; calibrated: when
  // the arm has another spread, `sigma`, with which an interaction is to begin.
  constructor(stage, point, release, calibrated) {
    Object.assign(this, { stage, point, release, calibrated, sigma: null, pointing: false });
    this.camera = new Camera($("#preview"), (joints, aspect) => this.#saw(joints, aspect), (reason) => this.#failed(reason));
    $("#arm-choice").hidden = !stage || !navigator.mediaDevices;
    for (const choice of document.querySelectorAll("[name=pointing]")) choice.addEventListener("change", () => this.#choose(choice.value === "camera"));
    $("#calibrate").addEventListener("click", () => this.#begin());
    $("#camera-off").addEventListener("click", () => this.#off());
    setInterval(() => this.#watch(), HUNG / 2);
  }

  // The language has changed.
  speak() {
    if (this.#state) this.#say(this.#state, this.#values);
    if ($("#camera-slow").textContent) $("#camera-slow").textContent = text("arm_slow");
  }

  // The table is another one.
  forget() {
    this.sigma = null;
    if (!this.#map && !this.#marks) return;
    this.#drop();
    this.#say("arm_moved");
  }

  // Put the ring where the picture has the mark.
  follow() {
    $("#mark").hidden = !this.#marks;
    if (!this.#marks) return;
    const { x, y } = this.stage.seen(this.#marks[this.#samples.length]);
    $("#mark").style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }

  async #choose(camera) {
    $("#camera").hidden = !camera;
    this.#drop();
    if (camera) {
      this.#say("arm_opening");
      this.#personAt = 0;
      this.#lastAt = null;
      this.#rate = QUICK;
      $("#camera-slow").textContent = "";
      await this.camera.open();
    } else {
      this.camera.close();
      this.#state = this.sigma = null; // from the next interaction on
    }
  }

  #off() {
    const mouse = $("[name=pointing][value=mouse]");
    mouse.checked = true;
    mouse.dispatchEvent(new Event("change"));
    $("#options").focus();
  }

  #failed(reason) {
    this.#drop();
    if (reason === null) this.#say("arm_lost");
    else this.#say("arm_denied", { reason });
  }

  #say(key, values = {}) {
    this.#state = key;
    this.#values = values;
    const line = text(key, values);
    if ($("#camera-state").textContent !== line) $("#camera-state").textContent = line;
    $("#calibrate").disabled = !this.camera.on || key === "arm_opening";
    $("#calibrate").textContent = text(this.#marks || this.#map ? "calibrate_again" : "calibrate");
  }

  #drop() {
    this.#marks = this.#map = this.#side = null;
    this.#samples = [];
    this.#end();
    this.follow();
  }

  // Calibration: marks in two rows of three over the items.

  #begin() {
    this.#drop();
    const { middle, ahead, right, height } = this.stage.frame;
    const reach = (axis) => Math.max(SPREAD, ...this.stage.scene.items.map((item) => Math.abs(vector(item.position).sub(middle).dot(axis))));
    const [wide, deep] = [reach(right), reach(ahead)];
    this.#marks = [[-1, 1], [0, 1], [1, 1], [1, -1], [0, -1], [-1, -1]].map(([x, y]) => middle.clone().addScaledVector(right, x * wide).addScaledVector(ahead, y * deep).setZ(height));
    this.#shape = this.#canvas();
    this.#still = new Stillness();
    this.#ask();
  }

  #ask() {
    this.follow();
    this.#say("arm_point", { number: this.#samples.length + 1, all: this.#marks.length });
  }

  #calibrate(side, hand) {
    if (side && this.#side && side !== this.#side) return this.#say("arm_other");
    const taken = this.#still.take(performance.now(), hand);
    if (!taken) return this.#ask();
    this.#side = side;
    this.#samples.push({ hand: taken, place: this.#placeOf(this.#marks[this.#samples.length]) });
    if (this.#samples.length < this.#marks.length) return this.#ask();
    return this.#conclude();
  }

  #conclude() {
    const head = vector(this.stage.scene.head), marks = this.#marks;
    const way = (place) => place.clone().sub(head);
    const judged = judge(this.#samples, (place, index) => {
      const at = this.#tableAt(place);
      return at ? way(at).angleTo(way(marks[index])) : Math.PI;
    });
    const found = sigma(judged);
    this.#marks = null;
    this.follow();
    this.#map = found === null ? null : fit(this.#samples);
    this.#lowered = false;
    this.#samples = [];
    const error = decimal(judged.error);
    if (found !== null) this.#say("arm_good", { error: decimal(found), degrees: Math.round((found * 180) / Math.PI) });
    else this.#say(judged.error > LARGEST ? "arm_coarse" : "arm_blind", { error, most: decimal(LARGEST), guess: decimal(judged.guess) });
    const before = this.sigma;
    this.sigma = found;
    if (found !== null && found !== before) this.calibrated();
  }

  // Places in the picture, from -1 to 1 each way, and the table's beneath them.

  #canvas() {
    const { left, top, width, height } = $("#view").getBoundingClientRect();
    return { left, top, width, height };
  }

  #placeOf(point) {
    const { x, y } = this.stage.seen(point), { width, height } = this.#canvas();
    return [(2 * x) / width - 1, (2 * y) / height - 1];
  }

  #tableAt([x, y]) {
    const { width, height } = this.#canvas();
    return this.stage.at(((x + 1) / 2) * width, ((y + 1) / 2) * height);
  }

  // What is seen.

  #saw(joints, aspect) {
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
    } else if (this.#marks) this.#calibrate(side, side && hands[side]);
    else this.#use(now, side === this.#side ? hands[side] : null);
  }

  #pace(now) {
    if (this.#lastAt !== null) this.#rate += 0.1 * (1000 / Math.max(now - this.#lastAt, 1) - this.#rate);
    this.#lastAt = now;
    if (this.#rate > QUICK) $("#camera-slow").textContent = "";
    else if (this.#rate < SLOW) $("#camera-slow").textContent = text("arm_slow");
  }

  #use(now, hand) {
    if (!this.#map) {
      if (!["arm_coarse", "arm_blind", "arm_moved"].includes(this.#state)) this.#say("arm_begin");
      return;
    }
    if (this.#moved()) return this.forget();
    const place = hand && this.#map(hand), fast = this.#fast(now, hand);
    if (!hand) this.#lowered = true;
    if (!place || fast || !this.#lowered || place.some((part) => Math.abs(part) > OUTSIDE)) this.#end();
    else {
      this.#upSince ??= now;
      this.pointing = now - this.#upSince >= HELD;
      if (this.pointing) this.point(this.#tableAt(place));
    }
    this.#say("arm_good", { error: decimal(this.sigma), degrees: Math.round((this.sigma * 180) / Math.PI) });
  }

  #fast(now, hand) {
    const before = this.#before;
    this.#before = hand && { now, hand };
    if (!hand || !before) return true;
    return Math.hypot(hand[0] - before.hand[0], hand[1] - before.hand[1]) / (now - before.now) > FAST / 1000;
  }

  // A picture elsewhere on the screen is pointed at otherwise.
  #moved() {
    const now = this.#canvas();
    return Object.entries(this.#shape).some(([side, length]) => Math.abs(now[side] - length) > 0.05 * this.#shape.width);
  }

  #end() {
    this.#upSince = null;
    if (this.pointing) this.release();
    this.pointing = false;
  }

  // An arm does not point on while no pictures come.
  #watch() {
    if (!this.camera.on || this.#lastAt === null || performance.now() - this.#lastAt < HUNG) return;
    this.#rate = 0;
    $("#camera-slow").textContent = text("arm_slow");
    this.#end();
  }
}
