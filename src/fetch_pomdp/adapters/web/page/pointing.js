// Where the person points: with the mouse or a finger held down, with an item's button, or with an arm.

import { vector } from "./geometry.js";

/** @import { Vector3 } from "three" */
/** @import { Point3, PageMessage, Scene } from "./messages.js" */

const ARM = 0.6; // m, from the head to the wrist of an arm that points
const REPEAT = 80; // ms between rays while the person points
const SHOWN = 1200; // ms that pointing by a button lasts

export class Pointing {
  /** @type {Scene | null} */
  scene = null;
  /** @type {Vector3 | null} */
  #target = null;
  /** @type {ReturnType<typeof setInterval> | null} */
  #timer = null;

  /**
   * @param {{ send: (message: PageMessage) => void }} connection
   * @param {(target: Vector3 | null) => void} onPoint called with what is pointed at, and null in the end
   */
  constructor(connection, onPoint) {
    this.connection = connection;
    this.onPoint = onPoint;
  }

  get on() {
    return this.#timer !== null;
  }

  /**
   * Point at a place from now on; null, where there is nothing to point at, changes nothing.
   * @param {Vector3 | null} place
   */
  at(place) {
    if (!place) return;
    this.#target = place;
    this.onPoint(place);
    if (this.on) return;
    this.#timer = setInterval(() => this.#send(), REPEAT);
    this.#send();
  }

  /** Point at an item, for a moment. @param {string} id */
  atItem(id) {
    const item = this.scene?.items.find((each) => each.id === id);
    if (!item) return;
    this.at(vector(item.position));
    setTimeout(() => this.end(), SHOWN);
  }

  end() {
    if (this.#timer === null) return;
    clearInterval(this.#timer);
    this.#timer = null;
    this.onPoint(null);
  }

  #send() {
    if (this.scene && this.#target)
      this.connection.send({ type: "ray", head: this.scene.head, wrist: wrist(this.scene.head, this.#target) });
  }
}

/** Where the wrist of an arm is that points from a head at a target. @param {Point3} head @param {Vector3} target */
export function wrist(head, target) {
  const from = vector(head);
  return from.add(target.clone().sub(from).setLength(ARM)).toArray();
}
