// What the robot thinks: why it acts, what each action is worth, and the story so far.

import { decimal, join, percent, phrase, text } from "./texts.js";

const MOST_ROWS = 12;

export class Mind {
  constructor() {
    this.body = document.querySelector("#values tbody");
    this.log = document.querySelector("#log");
    this.decided = null;
  }

  set(scene) {
    this.rows = new Map();
    this.body.replaceChildren();
    for (const item of scene.items.slice(0, MOST_ROWS)) {
      const row = this.body.insertRow(), head = document.createElement("th");
      head.scope = "row";
      head.textContent = item.id;
      row.append(head);
      const cells = [row.insertCell(), row.insertCell(), row.insertCell()];
      this.rows.set(item.id, { row, cells });
    }
    document.querySelector("#waiting").textContent = "";
    document.querySelector("#why").textContent = text("nothing");
    this.log.replaceChildren();
    this.decided = null;
  }

  believe(belief) {
    for (const [id, { cells }] of this.rows) cells[0].textContent = percent(belief[id]);
  }

  decide(message) {
    this.decided = message;
    if (!message.values) return;
    if (message.phrase) document.querySelector("#why").textContent = sentence(message.phrase);
    for (const [id, { row, cells }] of this.rows) {
      row.classList.toggle("about", id === message.item);
      this.#value(cells[1], message.values.point[id], message.action === "point" && id === message.item);
      this.#value(cells[2], message.values.pick[id], message.action === "pick" && id === message.item);
    }
    this.#value(document.querySelector("#waiting"), message.values.wait, message.action === "wait");
  }

  #value(cell, value, best) {
    cell.textContent = value === null ? "–" : decimal(value);
    cell.classList.toggle("best", best);
  }

  // An event becomes a line of the story; with insight, what it did to the belief follows.
  tell(message) {
    const line = message.type === "observed" ? perceived(message) : acted(message);
    const entry = document.createElement("li"), time = document.createElement("time"), said = document.createElement("span");
    time.textContent = message.t === undefined ? "" : `${decimal(message.t).slice(0, -1)} s`;
    said.append(line);
    entry.append(time, said);
    this.log.append(entry);
    this.log.parentElement.scrollTop = this.log.parentElement.scrollHeight;
    this.open = message.type === "observed" ? said : null;
  }

  // Add to the last line what it did to the belief.
  conclude(belief, even) {
    if (!this.open || !belief) return;
    const effect = document.createElement("em");
    effect.textContent = ` → ${even ? text("evenly") : leaders(belief)}`;
    this.open.append(effect);
    this.open = null;
  }
}

function sentence(why) {
  const words = phrase(why);
  return `${words[0].toUpperCase()}${words.slice(1)}.`;
}

function leaders(belief) {
  const sorted = Object.entries(belief).sort((one, other) => other[1] - one[1]);
  const leading = sorted.filter(([, share]) => share > sorted[0][1] / 2), named = leading.slice(0, 3).map(([id, share]) => `${id} ${percent(share)}`);
  if (leading.length > 3) named.push(text("more", { number: leading.length - 3 }));
  return text("leads", { items: join(named) });
}

function perceived({ observation, unknown }) {
  const parts = [];
  if (observation.utterance) parts.push(text("heard", { words: observation.utterance }));
  if (observation.head) parts.push(text("pointed"));
  if (unknown.length) parts.push(text("unknown", { words: unknown.join(", ") }));
  return parts.join("; ");
}

function acted({ action, item, outcome }) {
  const line = text(action === "point" ? "asked" : "handed", { item });
  if (outcome === "done") return line;
  return text(outcome === "stopped" ? "stopped" : "not_done", { action: line });
}
