// What the robot says: in a bubble over the picture, to screen readers, and aloud.

import { create, find } from "./dom.js";
import { english, isEnglish, text } from "./texts.js";

/** @import { Say } from "./messages.js" */
/** @import { TableView } from "./table-view.js" */

const MARGIN = 8; // pixels, of the bubble to the sides of the picture
const TAIL = 14; // pixels, between the bubble and the mouth
const TOP = 76; // pixels, of the bubble to the top
const LONG = 60; // letters of a line that is written smaller
const SHOWN = 3500; // ms that a sentence is shown
const READ = 9000; // ms that one with words to be read is shown

/** Whether a sentence asks something that waits for an answer. @param {Say} message */
export const isQuestion = ({ key }) => key === "asks" || key === "asking_again";

export class RobotVoice {
  #bubble = find("#bubble");
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer;
  #sound = new Audio();

  /** @param {TableView | null} view */
  constructor(view) {
    this.view = view;
  }

  /**
   * Show one of the page's texts in a bubble, in English and, beneath it, in the page's language.
   * @param {string} key
   * @param {number | null} duration ms; null: until something else is shown or the question is answered
   * @param {Record<string, string>} values
   */
  show(key, duration, values = {}) {
    const translated = isEnglish() ? [] : [create("small", { textContent: text(key, values) })];
    this.#showLine(english(key, values), duration, translated);
  }

  /** @param {string} line @param {number | null} duration @param {HTMLElement[]} translated */
  #showLine(line, duration, translated = []) {
    this.#bubble.replaceChildren(line, ...translated);
    this.#bubble.lang = "en";
    this.#bubble.classList.toggle("long", line.length > LONG);
    this.#bubble.hidden = false;
    this.announce(line);
    clearTimeout(this.#timer);
    if (duration !== null) this.#timer = setTimeout(() => this.hide(), duration);
    this.view?.draw();
  }

  hide() {
    this.#bubble.hidden = true;
  }

  /** Tell screen readers. @param {string} line */
  announce(line) {
    find("#spoken").textContent = line;
  }

  /**
   * Say something, and nothing else any more: the server's sound if there is one, else the browser's voice.
   * @param {Say} message
   */
  say(message) {
    const { key, text: line, audio, words } = message;
    const duration = isQuestion(message) ? null : words ? READ : SHOWN;
    if (key) this.show(key, duration, words ? { words } : {});
    else this.#showLine(line, duration);
    this.#sound.pause();
    if (!find("#voice", HTMLInputElement).checked) return;
    if (audio) {
      this.#sound = new Audio(audio);
      this.#sound.play().catch(() => {}); // before the first click a browser may forbid sound
    } else if (window.speechSynthesis) {
      const spoken = new SpeechSynthesisUtterance(line);
      spoken.lang = "en";
      speechSynthesis.cancel();
      speechSynthesis.speak(spoken);
    }
  }

  /** Put the bubble over the robot's head. @param {TableView} view */
  follow(view) {
    const { x, y } = view.mouth(),
      half = this.#bubble.offsetWidth / 2 + MARGIN,
      width = find("#view-area").clientWidth;
    const left = Math.min(Math.max(x, half), width - half),
      top = Math.max(y, TOP, this.#bubble.offsetHeight + TAIL + MARGIN);
    this.#bubble.style.transform = `translate(${left.toFixed(1)}px, ${top.toFixed(1)}px)`;
  }
}
