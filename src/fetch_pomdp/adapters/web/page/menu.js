// The menu and the settings: language, table, planner, and which panels are open.

import { find } from "./dom.js";

/** @import { SceneChoice, Welcome } from "./messages.js" */

const PANELS = [
  ["#options", "#settings"],
  ["#edit", "#editor"],
]; // each button, and what it opens

export class Menu {
  /** @type {string | null} */
  #ownTable = null; // the TOML of the last table that was not built in
  #insight = true;
  #language = find("#language", HTMLSelectElement);
  #scene = find("#scene", HTMLSelectElement);
  #planner = find("#planner", HTMLSelectElement);
  #thinking = find("#thinking");

  /**
   * @param {object} listeners
   * @param {(language: string) => void} listeners.onLanguage
   * @param {() => void} listeners.onBegin called when an interaction is to begin
   * @param {(open: boolean) => void} listeners.onEdit called when the editor was opened or closed
   * @param {() => string} listeners.editedTable the TOML of the editor's table
   */
  constructor({ onLanguage, onBegin, onEdit, editedTable }) {
    this.editedTable = editedTable;
    this.#language.addEventListener("change", () => onLanguage(this.#language.value));
    this.#scene.addEventListener("change", onBegin);
    this.#planner.addEventListener("change", onBegin);
    find("#again").addEventListener("click", () => {
      onBegin();
      find("#say").focus();
    });
    this.#thinking.addEventListener("click", () => {
      this.#thinking.setAttribute("aria-pressed", String(!this.#pressed));
      this.#applyThinking();
    });
    for (const [button, panel] of PANELS) {
      find(button).addEventListener("click", () => {
        this.#open(find(panel).hidden ? panel : null);
        onEdit(!find("#editor").hidden);
      });
    }
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.#close();
    });
  }

  get planner() {
    return this.#planner.value;
  }

  /** The table that is chosen. @returns {SceneChoice} */
  get table() {
    return this.#scene.value === "own" ? { toml: this.#ownTable ?? this.editedTable() } : this.#scene.value;
  }

  /** @param {string} name */
  set language(name) {
    this.#language.value = name;
  }

  /** Choose a table. @param {SceneChoice} table */
  choose(table) {
    if (typeof table !== "string") this.#ownTable = table.toml;
    this.#scene.value = typeof table === "string" ? table : "own";
  }

  /** Show what an interaction began with. @param {Welcome} message */
  welcome({ scene_name: name, planner, insight }) {
    this.#insight = insight;
    this.#thinking.hidden = !insight;
    this.#applyThinking();
    this.#scene.value = name ?? "own";
    find("#scene [value=own]", HTMLOptionElement).hidden = name !== null && this.#ownTable === null;
    this.#planner.value = planner ?? "";
  }

  get #pressed() {
    return this.#thinking.getAttribute("aria-pressed") === "true";
  }

  #applyThinking() {
    document.body.classList.toggle("plain", !this.#insight || !this.#pressed);
  }

  /** Open one panel, and close the others. @param {string | null} wanted */
  #open(wanted) {
    for (const [button, panel] of PANELS) {
      find(panel).hidden = panel !== wanted;
      find(button).setAttribute("aria-expanded", String(panel === wanted));
    }
  }

  #close() {
    for (const [button, panel] of PANELS) {
      if (find(panel).hidden) continue;
      find(button).click();
      find(button).focus();
    }
  }
}
