// What the robot does at a table: it asks by pointing, fetches, and rests.

import * as THREE from "./vendor/three.module.min.js";
import { outline, vector } from "./geometry.js";

/** @import { Object3D, Vector3 } from "three" */
/** @import { Frame } from "./geometry.js" */
/** @import { Scene } from "./messages.js" */
/** @import { Robot } from "./robot.js" */
/** @typedef {Robot["arms"][0]} Arm */
/**
 * @typedef {{ object: Object3D, arm: Arm, home: Vector3, below: number, back: (() => void)[] }} Held what is in the
 *   hand; below: m under the wrist; back: the movements that put it back
 */
/** @typedef {{ scene: Scene, frame: Frame, meshes: Map<string, Object3D> }} Table meshes: by item */

const BEHIND = 0.4; // m, of the robot's middle beyond the table's edge
const QUICKNESS = 6.5; // 1/s, of each movement towards its end

export const reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");

export class RobotMotion {
  /** @type {{ at: number, act: () => void }[]} */
  #steps = []; // movements to come, in the order of their times
  /** @type {Held | null} */
  #held = null;
  /** @type {Table | null} */
  #table = null;
  #person = new THREE.Vector3(0, -2, 1.3); // where it looks when nothing else is to be seen

  /** @param {Robot} robot @param {() => void} onBegin called when there is something to be drawn */
  constructor(robot, onBegin) {
    this.robot = robot;
    this.onBegin = onBegin;
  }

  /** Stand across a table. @param {Table} table */
  stand(table) {
    this.#table = table;
    const {
      scene,
      frame: { ahead, middle, height },
    } = table;
    const edge = Math.max(...outline(scene).map((point) => point.x * ahead.x + point.y * ahead.y));
    const place = middle
      .clone()
      .addScaledVector(ahead, edge + BEHIND - middle.dot(ahead))
      .setZ(height - 0.75);
    this.robot.group.position.copy(place);
    this.robot.group.rotation.z = Math.atan2(ahead.y, ahead.x) - Math.PI / 2;
    this.robot.group.updateMatrixWorld(true);
    const deep = Math.max(...scene.items.map((item) => place.clone().sub(vector(item.position)).dot(ahead)));
    this.robot.setReach(Math.max(0.34, (Math.hypot(deep + 0.02, 0.4) - 0.1) / 2 + 0.02));
    this.#person = place.clone().addScaledVector(ahead, -2).setZ(scene.head[2]);
    this.rest();
  }

  /** Point at an item. @param {string} id */
  ask(id) {
    const { arm, item, above } = this.#turn(id);
    this.#then(0, () => {
      const goal = this.robot.local(item);
      const way = goal
        .clone()
        .setZ(goal.z + 0.05)
        .sub(arm.shoulder);
      arm.target
        .copy(arm.shoulder)
        .addScaledVector(way.clone().normalize(), Math.min(arm.reach * 0.97, way.length() - 0.24));
      arm.target.z = Math.max(arm.target.z, goal.z + 0.2);
      arm.aim = this.robot.local(above);
      arm.pointing = 1;
      arm.grip = 0;
    });
  }

  /** Take an item and hold it out to the person. @param {string} id */
  fetch(id) {
    const { arm, object, above } = this.#turn(id);
    const home = object.position.clone(),
      top = object.userData.top;
    const down = above.clone().setZ(home.z + top * 0.6 + 0.075),
      over = above.clone().setZ(home.z + top + 0.22);
    /** @param {Vector3} point */
    const to = (point) => {
      arm.target.copy(this.robot.local(point));
      arm.aim = this.robot.local(point.clone().setZ(point.z - 1));
    };
    this.#then(0, () => {
      to(over);
      arm.grip = 1;
    });
    this.#then(0.75, () => to(down));
    this.#then(1.2, () => {
      arm.grip = 0.35;
      this.#held = { object, arm, home, below: down.z - home.z, back: [() => to(over), () => to(down)] };
    });
    this.#then(1.25, () => to(over.clone().setZ(over.z + 0.1)));
    const near = Math.max(arm.reach * 0.93, 0.3);
    this.#then(1.75, () => {
      arm.target.copy(arm.shoulder).add(new THREE.Vector3(-0.35 * arm.side, -1, -0.06).setLength(near));
      arm.aim = arm.target.clone().add(new THREE.Vector3(0, -0.4, -1));
      this.robot.gaze.copy(this.#person);
    });
  }

  /** Put what is in the hand back where it was. */
  putBack() {
    const [over, down] = this.#held?.back ?? [];
    if (!over) return this.rest();
    this.#steps = [];
    this.#then(0, over);
    this.#then(0.9, down);
    this.#then(1.5, () => this.rest());
  }

  /** Let go of everything, also of what is in the hand. */
  rest() {
    this.#steps = [];
    this.#held?.object.position.copy(this.#held.home);
    this.#held = null;
    for (const arm of this.robot.arms)
      Object.assign(arm, { aim: null, pointing: 0, grip: 1, target: arm.rest.clone() });
    this.robot.gaze.copy(this.#person);
    this.onBegin();
  }

  /**
   * Look at what the person points at; null: at the person again, unless there is something to do.
   * @param {Vector3 | null} target
   */
  look(target) {
    if (target) this.robot.gaze.copy(target);
    else if (!this.#steps.length) this.robot.gaze.copy(this.#person);
  }

  /**
   * Move on; true while something moves.
   * @param {number} now ms
   * @param {number} seconds since the picture before
   * @param {boolean} blinking
   */
  step(now, seconds, blinking) {
    while (this.#steps.length && this.#steps[0].at <= now) this.#steps.shift()?.act();
    const moving = this.robot.step(reducedMotion.matches ? 1 : 1 - Math.exp(-QUICKNESS * seconds), blinking);
    if (this.#held) {
      const hand = this.robot.body.localToWorld(this.#held.arm.hand.clone());
      this.#held.object.position.copy(hand).setZ(hand.z - this.#held.below);
    }
    return moving || this.#steps.length > 0;
  }

  /** Turn to an item, with the arm on its side. @param {string} id */
  #turn(id) {
    const object = this.#table?.meshes.get(id),
      found = this.#table?.scene.items.find((each) => each.id === id);
    if (!this.#table || !object || !found) throw new RangeError(`found ${id}, expected an item of the table`);
    this.rest();
    const { middle, right } = this.#table.frame,
      item = vector(found.position);
    const across = item.clone().sub(middle).dot(right);
    this.robot.glideTarget = Math.sign(across) * Math.max(0, Math.abs(across) - 0.3);
    this.robot.gaze.copy(item);
    return { arm: this.robot.arms[across > 0 ? 1 : 0], object, item, above: item.clone().setZ(item.z + 0.03) };
  }

  /** @param {number} after seconds @param {() => void} act */
  #then(after, act) {
    this.#steps.push({ at: performance.now() + (reducedMotion.matches ? 0 : after * 1000), act });
    this.onBegin();
  }
}
