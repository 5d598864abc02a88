// Editing a table: items dragged in the picture, moved with the arrow keys or typed in, saved and opened as TOML.

import { text } from "./texts.js";

const NEAR = 0.12; // m, how far from an item it can be grabbed
const NUDGE = 0.01; // m, of an arrow key
const MOVES = { ArrowLeft: [-NUDGE, 0], ArrowRight: [NUDGE, 0], ArrowUp: [0, NUDGE], ArrowDown: [0, -NUDGE] };
const COORDINATES = ["across", "away", "height"];

export class Editor {
  constructor(stage, labels, use) {
    this.stage = stage;
    this.labels = labels;
    this.use = use; // called with the TOML of a table to be used
    this.open = false;
    this.held = null;
    this.items = [];
    this.rows = document.querySelector("#rows");
    document.querySelector("#add").addEventListener("click", () => this.#add());
    document.querySelector("#use").addEventListener("click", () => this.#use(this.toml()));
    document.querySelector("#download").addEventListener("click", () => this.#download());
    document.querySelector("#upload").addEventListener("change", (event) => this.#upload(event.target));
    document.querySelector("#items").addEventListener("keydown", (event) => this.#nudge(event));
  }

  load(scene) {
    this.head = scene.head;
    this.items = scene.items.map((item) => ({ id: item.id, position: item.position.map((part) => Math.round(part * 1000) / 1000), words: item.vocabulary.join(", ") }));
    this.#say("");
    this.#list();
  }

  shown(open) {
    this.open = open;
    this.held = null;
  }

  // An error of the server is the editor's if a table was sent; true if it was.
  refused(message) {
    if (!this.sent) return false;
    this.sent = false;
    this.#say(message);
    return true;
  }

  toml() {
    const quoted = (value) => JSON.stringify(value);
    const number = (value) => (Number.isFinite(value) ? value.toFixed(4).replace(/(\.\d*?[1-9]|\.0)0*$/, "$1") : "nan");
    const place = (position) => `[${position.map(number).join(", ")}]`;
    const tables = this.items.map((item) => `[[items]]\nid = ${quoted(item.id)}\nposition = ${place(item.position)}  # m\nvocabulary = [${wordsOf(item).map(quoted).join(", ")}]\n`);
    return [`head = ${place(this.head)}  # m, of the person\n`, ...tables].join("\n");
  }

  // Dragging, with a place on the table (Vector3).

  grab(place) {
    if (!place) return;
    const distance = (item) => Math.hypot(item.position[0] - place.x, item.position[1] - place.y);
    const nearest = this.items.reduce((best, item) => (distance(item) < distance(best) ? item : best));
    this.held = distance(nearest) < NEAR ? nearest : null;
  }

  drag(place) {
    if (place) this.#move(this.held, [place.x, place.y]);
  }

  drop() {
    this.held = null;
  }

  #nudge(event) {
    const item = this.items.find((each) => each.id === event.target.dataset.item);
    if (!this.open || !item || !(event.key in MOVES)) return;
    event.preventDefault();
    this.#move(item, MOVES[event.key].map((step, axis) => item.position[axis] + step));
  }

  #move(item, [x, y]) {
    item.position[0] = Math.round(x * 1000) / 1000;
    item.position[1] = Math.round(y * 1000) / 1000;
    this.stage?.put(item.id, item.position);
    const row = this.rows.children[this.items.indexOf(item)];
    row.querySelectorAll("[type=number]").forEach((input, axis) => { input.value = item.position[axis]; });
  }

  #list() {
    this.rows.replaceChildren(...this.items.map((item) => this.#row(item)));
  }

  #row(item) {
    const row = document.createElement("fieldset"), legend = document.createElement("legend"), remove = document.createElement("button");
    legend.textContent = item.id;
    const name = field(text("name"), item.id, "text", (value) => { item.id = value; legend.textContent = value; });
    const words = field(text("words"), item.words, "text", (value) => { item.words = value; });
    name.className = words.className = "wide";
    const places = COORDINATES.map((key, axis) => field(text(key), item.position[axis], "number", (value) => {
      item.position[axis] = Number(value);
      this.stage?.put(item.id, item.position);
    }));
    remove.type = "button";
    remove.textContent = text("remove", { item: item.id });
    remove.addEventListener("click", () => { this.items = this.items.filter((each) => each !== item); this.#list(); });
    row.append(legend, name, words, ...places, remove);
    return row;
  }

  #add() {
    const last = this.items.at(-1)?.position ?? [0, 1, 0.75];
    this.items.push({ id: `item-${this.items.length + 1}`, position: [last[0] + 0.15, last[1], last[2]], words: "cup, red" });
    this.#list();
    this.rows.lastElementChild.querySelector("input").select();
  }

  #use(toml) {
    this.#say("");
    this.sent = true;
    this.use(toml);
  }

  #download() {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([this.toml()], { type: "application/toml" }));
    link.download = "table.toml";
    link.click();
    URL.revokeObjectURL(link.href);
  }

  async #upload(input) {
    const [file] = input.files;
    input.value = "";
    if (file) this.#use(await file.text());
  }

  #say(line) {
    document.querySelector("#editor-error").textContent = line;
  }
}

function wordsOf(item) {
  return item.words.split(/[\s,]+/).filter(Boolean);
}

function field(name, value, type, changed) {
  const label = document.createElement("label"), input = document.createElement("input");
  input.type = type;
  if (type === "number") input.step = "0.01";
  input.value = value;
  input.addEventListener("input", () => changed(input.value));
  label.append(name, input);
  return label;
}
