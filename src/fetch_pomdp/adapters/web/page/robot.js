// The robot's body: a base that glides, a head that looks, two arms that reach. Its own frame: it faces -y, z is up.

import * as THREE from "./vendor/three.module.min.js";

/** @import { BufferGeometry, Group, Mesh, Vector3 } from "three" */

const WHITE = 0xfafaf8,
  GREY = 0xb9bec1,
  DARK = 0x2b3238,
  ACCENT = 0x1d6f6a;
const SHOULDER = { side: 0.25, ahead: 0.02, height: 1.12 };
const UP = new THREE.Vector3(0, 1, 0);

/** @param {BufferGeometry} geometry @param {number} colour */
function part(geometry, colour, roughness = 0.55) {
  const mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color: colour, roughness }));
  mesh.castShadow = true;
  return mesh;
}

/**
 * A box with round edges, drawn in the x-z plane and rounded along y.
 * @param {[width: number, height: number, depth: number]} size m
 * @param {number} radius m
 */
function rounded([width, height, depth], radius) {
  const shape = new THREE.Shape();
  const x = width / 2 - radius,
    z = height / 2 - radius;
  shape
    .absarc(x, z, radius, 0, Math.PI / 2)
    .absarc(-x, z, radius, Math.PI / 2, Math.PI)
    .absarc(-x, -z, radius, Math.PI, 1.5 * Math.PI)
    .absarc(x, -z, radius, 1.5 * Math.PI, 2 * Math.PI);
  const bevel = Math.min(radius * 0.6, depth / 3);
  const geometry = new THREE.ExtrudeGeometry(shape, {
    depth: depth - 2 * bevel,
    bevelThickness: bevel,
    bevelSize: bevel * 0.9,
    bevelOffset: -bevel * 0.9,
    bevelSegments: 5,
    curveSegments: 10,
  });
  return geometry.center().rotateX(Math.PI / 2);
}

class RobotArm {
  /** @param {Group} body @param {number} side -1: its right, 1: its left */
  constructor(body, side) {
    this.side = side;
    this.length = 0.36;
    this.shoulder = new THREE.Vector3(side * SHOULDER.side, -SHOULDER.ahead, SHOULDER.height);
    this.rest = new THREE.Vector3(side * 0.3, -0.3, 0.86);
    this.hand = this.rest.clone(); // where the wrist is
    this.target = this.rest.clone();
    /** @type {Vector3 | null} */
    this.aim = null; // what the hand points at, or null for straight on
    this.grip = 1; // 0 closed, 1 open
    this.pointing = 0; // 1: one finger out
    /** @param {number} radius */
    const ball = (radius) => part(new THREE.SphereGeometry(radius, 24, 16), GREY);
    /** @param {number} top @param {number} bottom */
    const bone = (top, bottom) => part(new THREE.CylinderGeometry(top, bottom, 1, 24).translate(0, 0.5, 0), WHITE);
    this.upper = bone(0.042, 0.05);
    this.lower = bone(0.033, 0.042);
    this.elbow = ball(0.05);
    this.wrist = new THREE.Group().add(part(new THREE.SphereGeometry(0.046, 24, 16).scale(1, 1.1, 0.75), GREY));
    this.fingers = [this.#finger(-1), this.#finger(1)];
    this.wrist.add(...this.fingers);
    const shoulder = ball(0.068);
    shoulder.position.copy(this.shoulder);
    body.add(shoulder, this.upper, this.lower, this.elbow, this.wrist);
  }

  /** @param {number} side */
  #finger(side) {
    const joint = new THREE.Group().add(
      part(new THREE.CapsuleGeometry(0.0125, 0.07, 4, 12).translate(0, 0.045, 0), ACCENT),
    );
    joint.position.set(side * 0.026, 0.03, 0);
    return joint;
  }

  /** How far (m) the wrist may be from the shoulder. */
  get reach() {
    return 2 * this.length * 0.995;
  }

  /**
   * Move towards the target by a share of the way, and bend the elbow so that it fits; true while it moves.
   * @param {number} share
   */
  step(share) {
    const wanted = this.target.clone().sub(this.shoulder);
    if (wanted.length() > this.reach) wanted.setLength(this.reach);
    this.hand.lerp(wanted.add(this.shoulder), share);
    const way = this.hand.clone().sub(this.shoulder);
    const distance = Math.min(Math.max(way.length(), 0.12), this.reach);
    const along = way.normalize();
    const outward = new THREE.Vector3(this.side * 0.75, 0.35, -0.8);
    const bend = outward.addScaledVector(along, -outward.dot(along)).normalize();
    const elbow = this.shoulder
      .clone()
      .addScaledVector(along, distance / 2)
      .addScaledVector(bend, Math.sqrt(Math.max(this.length ** 2 - distance ** 2 / 4, 0)));
    this.elbow.position.copy(elbow);
    stretch(this.upper, this.shoulder, elbow);
    stretch(this.lower, elbow, this.hand);
    this.wrist.position.copy(this.hand);
    const ahead = (this.aim ?? this.hand.clone().add(this.hand).sub(elbow)).clone().sub(this.hand).normalize();
    this.wrist.quaternion.slerp(new THREE.Quaternion().setFromUnitVectors(UP, ahead), Math.min(1, share * 1.5));
    this.fingers[0].rotation.z = mix(0.28 * this.grip, -1.5, this.side > 0 ? this.pointing : 0);
    this.fingers[1].rotation.z = -mix(0.28 * this.grip, -1.5, this.side > 0 ? 0 : this.pointing);
    return this.hand.distanceTo(this.target) > 0.002 && this.target.distanceTo(this.shoulder) < this.reach;
  }
}

/** @param {number} from @param {number} to @param {number} share */
function mix(from, to, share) {
  return from + (to - from) * share;
}

/** @param {Mesh} mesh @param {Vector3} from @param {Vector3} to */
function stretch(mesh, from, to) {
  const way = to.clone().sub(from);
  mesh.position.copy(from);
  mesh.scale.set(1, way.length(), 1);
  mesh.quaternion.setFromUnitVectors(UP, way.normalize());
}

export class Robot {
  constructor() {
    this.group = new THREE.Group();
    this.body = new THREE.Group();
    this.group.add(this.body);
    const base = part(new THREE.CylinderGeometry(0.27, 0.31, 0.14, 40).rotateX(Math.PI / 2), GREY);
    base.position.z = 0.09;
    const column = part(new THREE.CylinderGeometry(0.11, 0.15, 0.62, 32).rotateX(Math.PI / 2), WHITE);
    column.position.z = 0.44;
    const torso = part(rounded([0.42, 0.5, 0.26], 0.12), WHITE);
    torso.position.set(0, 0.02, 0.98);
    const badge = part(new THREE.CylinderGeometry(0.036, 0.036, 0.012, 32), ACCENT);
    badge.position.set(0, -0.112, 1.02);
    const neck = part(new THREE.CylinderGeometry(0.055, 0.065, 0.12, 24).rotateX(Math.PI / 2), GREY);
    neck.position.z = 1.27;
    this.head = new THREE.Group();
    this.head.position.z = 1.44;
    this.eyes = [eye(-1), eye(1)];
    const skull = part(rounded([0.34, 0.24, 0.22], 0.1), WHITE);
    const screen = part(rounded([0.27, 0.16, 0.04], 0.07), DARK, 0.3);
    screen.position.y = -0.1;
    this.head.add(skull, screen, ...this.eyes);
    this.body.add(base, column, torso, badge, neck, this.head);
    this.arms = [new RobotArm(this.body, -1), new RobotArm(this.body, 1)];
    this.gaze = new THREE.Vector3(0, -2, 1.3);
    this.glide = 0; // m to the side, where the base stands
    this.glideTarget = 0;
  }

  /** Where something in the world is, in the body's frame. @param {Vector3} point */
  local(point) {
    return this.body.worldToLocal(point.clone());
  }

  /** @param {number} length m, of each half of an arm */
  setReach(length) {
    for (const arm of this.arms) arm.length = length;
  }

  /** One step of all movements; true while something moves. @param {number} share of the way @param {boolean} blink */
  step(share, blink) {
    const before = this.body.position.x;
    this.body.position.x += (this.glideTarget - before) * share;
    let moving = Math.abs(this.body.position.x - this.glideTarget) > 0.002;
    this.group.updateMatrixWorld(true);
    for (const arm of this.arms) moving = arm.step(share) || moving;
    const look = this.local(this.gaze).sub(this.head.position);
    const turn = Math.atan2(look.x, -look.y),
      nod = Math.atan2(look.z, Math.hypot(look.x, look.y));
    const wanted = new THREE.Euler(-Math.max(-0.5, Math.min(0.3, nod)), 0, Math.max(-0.9, Math.min(0.9, turn)), "ZXY");
    this.head.quaternion.slerp(new THREE.Quaternion().setFromEuler(wanted), share);
    for (const each of this.eyes) each.scale.z = blink ? 0.12 : 1;
    return moving;
  }
}

/** @param {number} side */
function eye(side) {
  const made = new THREE.Mesh(
    new THREE.CapsuleGeometry(0.019, 0.016, 4, 16).rotateX(Math.PI / 2),
    new THREE.MeshBasicMaterial({ color: 0xa8efe6 }),
  );
  made.position.set(side * 0.062, -0.117, 0.005);
  made.scale.y = 0.35;
  return made;
}
