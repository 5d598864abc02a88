// A table while it is edited: items that are moved, named and described, and its scene file (TOML). No browser needed.

/** @import { Point3, Scene } from "./messages.js" */
/** @typedef {{ id: string, position: Point3, words: string }} DraftItem words: its vocabulary, as it is typed */

const NEAR = 0.12; // m, how far from an item it can be grabbed

export class TableDraft {
  /** @type {DraftItem[]} */
  items = [];
  /** @type {Point3} */
  head = [0, 0, 1.6];

  /** @param {Scene} scene */
  load(scene) {
    this.head = scene.head;
    this.items = scene.items.map(({ id, position: [x, y, z], vocabulary }) => ({
      id,
      position: [millimetres(x), millimetres(y), millimetres(z)],
      words: vocabulary.join(", "),
    }));
  }

  add() {
    const [x, y, z] = this.items.at(-1)?.position ?? [0, 1, 0.75];
    this.items.push({ id: `item-${this.items.length + 1}`, position: [x + 0.15, y, z], words: "cup, red" });
  }

  /** @param {DraftItem} item */
  remove(item) {
    this.items = this.items.filter((each) => each !== item);
  }

  /** @param {DraftItem} item @param {number} x @param {number} y */
  move(item, x, y) {
    item.position[0] = millimetres(x);
    item.position[1] = millimetres(y);
  }

  /** The item that is grabbed at a place of the table, if one is near. @param {number} x @param {number} y */
  nearest(x, y) {
    /** @param {DraftItem} item */
    const distance = ({ position }) => Math.hypot(position[0] - x, position[1] - y);
    const near = this.items.filter((item) => distance(item) < NEAR);
    return near.reduce(
      (/** @type {DraftItem | null} */ best, item) => (best && distance(best) <= distance(item) ? best : item),
      null,
    );
  }

  /**
   * Its scene file (docs/scenes.md). What was typed and is no number becomes `nan`, which the server refuses by name.
   */
  toml() {
    const tables = this.items.map(({ id, position, words }) => {
      const vocabulary = wordsOf(words).map(quoted).join(", ");
      return `[[items]]\nid = ${quoted(id)}\nposition = ${place(position)}  # m\nvocabulary = [${vocabulary}]\n`;
    });
    return [`head = ${place(this.head)}  # m, of the person\n`, ...tables].join("\n");
  }
}

/** @param {number} length */
const millimetres = (length) => Math.round(length * 1000) / 1000;
/** @param {string} value */
const quoted = (value) => JSON.stringify(value);
/** @param {number} value */
const number = (value) => (Number.isFinite(value) ? value.toFixed(4).replace(/(\.\d*?[1-9]|\.0)0*$/, "$1") : "nan");
/** @param {Point3} position */
const place = (position) => `[${position.map(number).join(", ")}]`;
/** @param {string} words */
const wordsOf = (words) => words.split(/[\s,]+/).filter(Boolean);
