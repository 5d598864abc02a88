// Editing a table: items dragged in the picture, moved with the arrow keys or typed in, saved and opened as TOML.

import { create, find } from "./dom.js";
import { TableDraft } from "./table-draft.js";
import { text } from "./texts.js";

/** @import { Scene } from "./messages.js" */
/** @import { DraftItem } from "./table-draft.js" */
/** @import { TableView } from "./table-view.js" */
/** @import { Vector3 } from "three" */

const NUDGE = 0.01; // m, of an arrow key
/** @type {Record<string, [number, number]>} */
const MOVES = { ArrowLeft: [-NUDGE, 0], ArrowRight: [NUDGE, 0], ArrowUp: [0, NUDGE], ArrowDown: [0, -NUDGE] };
const COORDINATES = ["across", "away", "height"];

export class Editor {
  open = false;
  #draft = new TableDraft();
  /** @type {DraftItem | null} */
  #held = null;
  #sent = false; // a table whose error, if it has one, is still to come
  #rows = find("#rows");

  /**
   * @param {TableView | null} view
   * @param {(toml: string) => void} onUse called with the TOML of a table to be used
   */
  constructor(view, onUse) {
    this.view = view;
    this.onUse = onUse;
    find("#add").addEventListener("click", () => this.#add());
    find("#use").addEventListener("click", () => this.#use(this.toml()));
    find("#download").addEventListener("click", () => this.#download());
    find("#upload").addEventListener("change", () => this.#upload());
    find("#items").addEventListener("keydown", (event) => this.#nudge(event));
  }

  get dragging() {
    return this.#held !== null;
  }

  /** @param {Scene} scene */
  load(scene) {
    this.#draft.load(scene);
    this.#say("");
    this.#list();
  }

  /** @param {boolean} open */
  show(open) {
    this.open = open;
    this.#held = null;
  }

  /** An error of the server is the editor's if a table was sent; true if it was. @param {string} message */
  refused(message) {
    if (!this.#sent) return false;
    this.#sent = false;
    this.#say(message);
    return true;
  }

  toml() {
    return this.#draft.toml();
  }

  /** @param {Vector3 | null} place */
  grab(place) {
    if (place) this.#held = this.#draft.nearest(place.x, place.y);
  }

  /** @param {Vector3 | null} place */
  drag(place) {
    if (place && this.#held) this.#move(this.#held, place.x, place.y);
  }

  drop() {
    this.#held = null;
  }

  /** @param {KeyboardEvent} event */
  #nudge(event) {
    const id = event.target instanceof HTMLElement ? event.target.dataset.item : undefined;
    const item = this.#draft.items.find((each) => each.id === id);
    if (!this.open || !item || !(event.key in MOVES)) return;
    event.preventDefault();
    const [x, y] = MOVES[event.key];
    this.#move(item, item.position[0] + x, item.position[1] + y);
  }

  /** @param {DraftItem} item @param {number} x @param {number} y */
  #move(item, x, y) {
    this.#draft.move(item, x, y);
    this.view?.put(item.id, item.position);
    const row = this.#rows.children[this.#draft.items.indexOf(item)];
    row.querySelectorAll("input[type=number]").forEach((input, axis) => {
      if (input instanceof HTMLInputElement) input.value = String(item.position[axis]);
    });
  }

  #list() {
    this.#rows.replaceChildren(...this.#draft.items.map((item) => this.#row(item)));
  }

  /** @param {DraftItem} item */
  #row(item) {
    const legend = create("legend", { textContent: item.id });
    const name = field(text("name"), item.id, (value) => {
      item.id = value;
      legend.textContent = value;
    });
    const words = field(text("words"), item.words, (value) => {
      item.words = value;
    });
    name.className = words.className = "wide";
    const places = COORDINATES.map((key, axis) =>
      field(text(key), item.position[axis], (value) => {
        item.position[axis] = Number(value);
        this.view?.put(item.id, item.position);
      }),
    );
    const remove = create("button", { type: "button", textContent: text("remove", { item: item.id }) });
    remove.addEventListener("click", () => {
      this.#draft.remove(item);
      this.#list();
    });
    return create("fieldset", {}, legend, name, words, ...places, remove);
  }

  #add() {
    this.#draft.add();
    this.#list();
    this.#rows.lastElementChild?.querySelector("input")?.select();
  }

  /** @param {string} toml */
  #use(toml) {
    this.#say("");
    this.#sent = true;
    this.onUse(toml);
  }

  #download() {
    const link = create("a", {
      href: URL.createObjectURL(new Blob([this.toml()], { type: "application/toml" })),
      download: "table.toml",
    });
    link.click();
    URL.revokeObjectURL(link.href);
  }

  async #upload() {
    const input = find("#upload", HTMLInputElement),
      file = input.files?.[0];
    input.value = "";
    if (file) this.#use(await file.text());
  }

  /** @param {string} line */
  #say(line) {
    find("#editor-error").textContent = line;
  }
}

/**
 * A labelled input: of numbers for a number.
 * @param {string} name
 * @param {string | number} value
 * @param {(value: string) => void} onChange
 */
function field(name, value, onChange) {
  const input =
    typeof value === "number" ? create("input", { type: "number", step: "0.01" }) : create("input", { type: "text" });
  input.value = String(value);
  input.addEventListener("input", () => onChange(input.value));
  return create("label", {}, name, input);
}
