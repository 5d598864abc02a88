// The items' names, and the belief in them, over the picture; for the keyboard, buttons that point.

import { create } from "./dom.js";
import { frame, vector } from "./geometry.js";
import { percent, text } from "./texts.js";

/** @import { Belief, Item, Scene } from "./messages.js" */
/** @import { TableView } from "./table-view.js" */
/** @import { Vector3 } from "three" */
/** @typedef {{ entry: HTMLElement, button: HTMLElement, name: HTMLElement, share: HTMLElement, item: Item }} Label */

/** What an item is, without its number: "marker" of "marker-1". @param {Item} item */
export const kind = (item) => item.id.replace(/[-_ ]?\d+$/, "") || item.id;

/**
 * An item in words, for people to whom ids would say too much: "the marker on the left".
 * @param {Item} item
 * @param {Scene} scene
 */
export function described(item, scene) {
  const alike = scene.items.filter((each) => kind(each) === kind(item));
  if (alike.length === 1) return text("item_only", { kind: kind(item) });
  const { right, ahead } = frame(scene);
  /** @param {Vector3} way @returns {(each: Item) => number} */
  const along = (way) => (each) => vector(each.position).dot(way);
  /** @param {Vector3} way */
  const spread = (way) => Math.max(...alike.map(along(way))) - Math.min(...alike.map(along(way)));
  const sideways = spread(right) >= spread(ahead),
    way = along(sideways ? right : ahead);
  const place = [...alike].sort((one, other) => way(one) - way(other)).indexOf(item);
  if (alike.length === 2)
    return text(`item_${sideways ? ["left", "right"][place] : ["near", "far"][place]}`, { kind: kind(item) });
  return text(sideways ? "item_from_left" : "item_from_near", { kind: kind(item), place: place + 1, of: alike.length });
}

export class Labels {
  /** @type {Map<string, Label>} */
  #labels = new Map();
  /** @type {Scene | null} */
  #scene = null;
  #insight = false;

  /**
   * @param {HTMLElement} list
   * @param {(id: string) => void} onPress
   */
  constructor(list, onPress) {
    this.list = list;
    this.onPress = onPress;
    this.inWords = false; // in studies, items are described instead of named by their ids
  }

  /** @param {Scene} scene @param {boolean} insight whether people may know what the robot believes */
  set(scene, insight) {
    this.#scene = scene;
    this.#insight = insight;
    this.list.replaceChildren();
    this.#labels.clear();
    for (const item of scene.items) {
      const name = create("span", { textContent: this.inWords ? kind(item) : item.id }),
        share = create("span", { className: "percent" });
      const bar = create("span", { className: "bar", ariaHidden: "true" }, create("i"));
      const button = create("button", { type: "button" }, name, share);
      button.dataset.item = item.id;
      button.addEventListener("click", () => this.onPress(item.id));
      const entry = create("li", {}, bar, button),
        label = { entry, button, name, share, item };
      this.list.append(entry);
      this.#labels.set(item.id, label);
      this.#name(label, null);
    }
  }

  /** @param {Belief} belief @param {boolean} provisional whether the step still goes on */
  believe(belief, provisional) {
    for (const [id, label] of this.#labels) {
      label.entry.style.setProperty("--belief", belief[id].toFixed(4));
      label.entry.classList.toggle("provisional", provisional);
      label.share.textContent = percent(belief[id]);
      if (!provisional) this.#name(label, belief[id]);
    }
  }

  /** Mark the item that the robot asks about or fetches. @param {string | null} id */
  about(id) {
    for (const [each, { entry }] of this.#labels) entry.classList.toggle("about", each === id);
  }

  /** Say which item the person is to get. @param {string} id @param {string} words */
  desire(id, words) {
    for (const [each, label] of this.#labels) {
      label.entry.classList.toggle("desired", each === id);
      label.name.textContent = each === id ? words : kind(label.item);
      this.#name(label, null);
    }
  }

  /** Put each label under its item, and its bar above it. @param {TableView} view */
  follow(view) {
    for (const [id, { entry }] of this.#labels) {
      const { foot, head } = view.extent(id);
      entry.style.transform = `translate(${foot.x.toFixed(1)}px, ${foot.y.toFixed(1)}px)`;
      entry.style.setProperty("--lift", `${(foot.y - head.y + 8).toFixed(1)}px`);
    }
  }

  /** @param {Label} label @param {number | null} share */
  #name({ button, item, name }, share) {
    const shown = this.inWords && this.#scene ? described(item, this.#scene) : item.id;
    const label =
      share === null || !this.#insight
        ? text("point_at", { item: shown })
        : text("point_at_believed", { item: item.id, percent: percent(share) });
    button.setAttribute("aria-label", this.inWords ? `${name.textContent}: ${label}` : label);
  }
}
