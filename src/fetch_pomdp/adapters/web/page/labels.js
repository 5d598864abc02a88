// The items' names, and the belief in them, over the picture; for the keyboard, buttons that point.

import { kind } from "./names.js";
import { percent, text } from "./texts.js";

export class Labels {
  constructor(list, pointAt) {
    this.list = list;
    this.pointAt = pointAt; // called with an item's id
    this.described = null; // in studies: makes words of an item of a scene, in the place of its id
    this.entries = new Map();
  }

  set(scene, insight) {
    this.scene = scene;
    this.insight = insight;
    this.list.replaceChildren();
    this.entries.clear();
    for (const item of scene.items) {
      const entry = document.createElement("li"), button = document.createElement("button"), bar = document.createElement("span");
      const name = document.createElement("span"), share = document.createElement("span");
      button.type = "button";
      name.textContent = this.described ? kind(item) : item.id;
      bar.className = "bar";
      bar.setAttribute("aria-hidden", "true");
      bar.append(document.createElement("i"));
      share.className = "percent";
      button.append(name, share);
      button.dataset.item = item.id;
      button.addEventListener("click", () => this.pointAt(item.id));
      entry.append(bar, button);
      this.list.append(entry);
      this.entries.set(item.id, { entry, button, name, share, item });
      this.#name(item.id, null);
    }
  }

  believe(belief, provisional) {
    for (const [id, { entry, share }] of this.entries) {
      entry.style.setProperty("--belief", belief[id].toFixed(4));
      entry.classList.toggle("provisional", provisional);
      share.textContent = percent(belief[id]);
      if (!provisional) this.#name(id, belief[id]);
    }
  }

  about(id) {
    for (const [each, { entry }] of this.entries) entry.classList.toggle("about", each === id);
  }

  // Say which item the person is to get.
  desire(id, words) {
    for (const [each, { entry, name, item }] of this.entries) {
      entry.classList.toggle("desired", each === id);
      name.textContent = each === id ? words : kind(item);
      this.#name(each, null);
    }
  }

  hide(id) {
    for (const [each, { entry }] of this.entries) entry.classList.toggle("gone", each === id);
  }

  // Put each label under its item, and its bar above it.
  follow(stage) {
    for (const [id, { entry }] of this.entries) {
      const object = stage.things.get(id);
      const foot = stage.seen(object.position), head = stage.seen(object.position.clone().setZ(object.position.z + object.userData.top));
      entry.style.transform = `translate(${foot.x.toFixed(1)}px, ${foot.y.toFixed(1)}px)`;
      entry.style.setProperty("--lift", `${(foot.y - head.y + 8).toFixed(1)}px`);
    }
  }

  #name(id, share) {
    const { button, item, name } = this.entries.get(id);
    const label = share === null || !this.insight ? text("point_at", { item: this.described?.(item, this.scene) ?? id }) : text("point_at_believed", { item: id, percent: percent(share) });
    button.setAttribute("aria-label", this.described ? `${name.textContent}: ${label}` : label);
  }
}
