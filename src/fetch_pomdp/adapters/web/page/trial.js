// One trial of a study: what it is about, its countdown, and what its person is told. No document needed.

import { described } from "./labels.js";
import { text } from "./texts.js";

/** @import { Decided, Scene, Stage, TrialStage } from "./messages.js" */

/** Whether a stage is a trial; the others are pages. @param {Stage} stage @returns {stage is TrialStage} */
export const isTrial = (stage) => stage.stage === "practice" || stage.stage === "trials";

/** Whether there is something to withdraw from. @param {Stage} stage */
export const canWithdraw = ({ stage }) => !["withdrawn", "declined", "full"].includes(stage);

export class Trial {
  /** @type {Scene | null} */
  scene = null;
  /** @type {string | null} */
  about = null; // the item that the robot pointed at last
  /** @type {ReturnType<typeof setInterval> | undefined} */
  #counting;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #giving;

  /** @param {TrialStage} stage */
  constructor(stage) {
    this.stage = stage;
  }

  get title() {
    const { stage, order, of } = this.stage;
    return text(stage === "practice" ? "round_practice" : "round", { round: order + 1, of });
  }

  /** What the person is to get. */
  get task() {
    return text("desired", { item: this.#words(this.stage.desired) });
  }

  /** What screen readers tell of a question: who does not see the table does not see what the robot points at. */
  get question() {
    return text("points_at", { item: this.#words(this.about) });
  }

  /** How it ended. @param {string | null} picked */
  outcome(picked) {
    return picked === null ? text("brought_none") : text("brought", { item: this.#words(picked) });
  }

  /** @param {Pick<Decided, "action" | "item">} message */
  decide({ action, item }) {
    if (action !== "wait") this.about = item ?? null;
  }

  /** Count the whole seconds down to 1. @param {number} seconds @param {(left: number) => void} onCount */
  countDown(seconds, onCount) {
    let left = Math.ceil(seconds);
    const count = () => {
      onCount(left);
      left -= 1;
    };
    count();
    this.#counting = setInterval(() => {
      if (left > 0) count();
    }, 1000);
  }

  /**
   * The interaction begins, or goes on at `t` (s).
   * @param {number} t
   * @param {() => void} onGiveUp called once it may be given up
   */
  begin(t, onGiveUp) {
    clearInterval(this.#counting);
    this.#giving = setTimeout(onGiveUp, (this.stage.give_up - t) * 1000);
  }

  /** Nothing is counted any more. */
  end() {
    clearInterval(this.#counting);
    clearTimeout(this.#giving);
  }

  /** @param {string | null} id */
  #words(id) {
    const item = this.scene?.items.find((each) => each.id === id);
    if (!this.scene || !item) throw new RangeError(`found ${id}, expected an item of the table`);
    return described(item, this.scene);
  }
}
