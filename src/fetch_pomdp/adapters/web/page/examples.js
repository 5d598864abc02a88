// What might be said before anything is: requests to click, which are then said for the person.

import { create, find } from "./dom.js";
import { text } from "./texts.js";

export class Examples {
  #label = create("span", { ariaHidden: "true" });

  /**
   * @param {HTMLElement} place
   * @param {(words: string) => void} onChoose
   */
  constructor(place, onChoose) {
    this.place = place;
    this.onChoose = onChoose;
  }

  /** The requests of a table. @param {string[]} lines @param {boolean} shown */
  set(lines, shown) {
    this.place.replaceChildren(this.#label, ...lines.map((line) => this.#button(line)));
    this.place.hidden = !lines.length;
    this.translate();
    this.show(shown);
  }

  /** @param {boolean} shown */
  show(shown) {
    const lost = !shown && this.place.contains(document.activeElement);
    this.place.classList.toggle("away", !shown); // its room stays, so that the table does not jump
    if (lost) find("#say").focus();
  }

  /** Say it again, in a language that was chosen meanwhile; the requests are English. */
  translate() {
    this.#label.textContent = text("for_example");
  }

  /** @param {string} line */
  #button(line) {
    const button = create("button", { type: "button", lang: "en", textContent: line });
    button.addEventListener("click", () => {
      this.onChoose(line);
      find("#say").focus();
    });
    return button;
  }
}
