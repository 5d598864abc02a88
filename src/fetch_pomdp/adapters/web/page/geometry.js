// Where things are seen from, the outline of a table, and the cone of pointing.

import * as THREE from "./vendor/three.module.min.js";

/** @import { Point3, Scene } from "./messages.js" */
/** @import { PerspectiveCamera, Vector3 } from "three" */
/** @typedef {{ middle: Vector3, ahead: Vector3, right: Vector3, height: number }} Frame */

const WIDEST = 46,
  NARROWEST = 13; // degrees, of the camera's height
const MARGIN = 0.17; // m, of a table around its items
const NEAREST = 1.55; // m, of the camera to the middle of the items, unless the person is nearer

/** @param {Point3} point */
export const vector = (point) => new THREE.Vector3(...point);

/**
 * The horizontal way from the person to the middle of the items, and that middle.
 * @param {Scene} scene
 * @returns {Frame}
 */
export function frame(scene) {
  const middle = scene.items
    .reduce((sum, item) => sum.add(vector(item.position)), new THREE.Vector3())
    .divideScalar(scene.items.length);
  const ahead = middle.clone().sub(vector(scene.head)).setZ(0);
  if (ahead.length() < 0.01) ahead.set(0, 1, 0);
  ahead.normalize();
  return {
    middle,
    ahead,
    right: new THREE.Vector3(ahead.y, -ahead.x, 0),
    height: Math.min(...scene.items.map((item) => item.position[2])),
  };
}

/**
 * The outline of everything within `margin` (m) of the items' hull: in each direction the farthest item, and on.
 * @param {Scene} scene
 */
export function outline(scene, margin = MARGIN) {
  const points = [];
  for (let step = 0; step < 120; step += 1) {
    const angle = (step / 120) * 2 * Math.PI,
      x = Math.cos(angle),
      y = Math.sin(angle);
    const far = scene.items
      .map((item) => item.position)
      .reduce((best, at) => (at[0] * x + at[1] * y > best[0] * x + best[1] * y ? at : best));
    points.push(new THREE.Vector2(far[0] + margin * x, far[1] + margin * y));
  }
  return points;
}

/**
 * Put the camera on the person's side, as near as lets it see all points; `aspect`: width over height of the picture.
 * @param {PerspectiveCamera} camera
 * @param {Frame} frame
 * @param {{ head: Vector3, points: Vector3[], aspect: number }} seen
 */
export function place(camera, { middle, ahead }, { head, points, aspect }) {
  const near = Math.min(NEAREST, middle.clone().sub(head).setZ(0).length());
  for (let back = 0; back <= 6; back += 0.1) {
    camera.position
      .copy(middle)
      .addScaledVector(ahead, -near - back)
      .setZ(head.z + 0.1 + 0.3 * back);
    const fov = aimed(camera, points, aspect);
    if (fov <= WIDEST) {
      camera.fov = Math.max(fov, NARROWEST);
      break;
    }
    camera.fov = WIDEST;
  }
  camera.aspect = aspect;
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld(true);
}

/**
 * Turn the camera so that the points are in its middle; return the angle (degrees) it takes to see them all.
 * @param {PerspectiveCamera} camera
 * @param {Vector3[]} points
 * @param {number} aspect
 */
function aimed(camera, points, aspect) {
  const target = points.reduce((sum, point) => sum.add(point), new THREE.Vector3()).divideScalar(points.length);
  let tangent = Infinity;
  for (let turn = 0; turn < 3; turn += 1) {
    camera.lookAt(target);
    camera.updateMatrixWorld(true);
    const seen = points.map((point) =>
      point.clone().applyMatrix4(camera.matrixWorldInverse.copy(camera.matrixWorld).invert()),
    );
    if (seen.some((point) => point.z > -0.2)) return 180;
    const xs = seen.map((point) => point.x / -point.z),
      ys = seen.map((point) => point.y / -point.z);
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    tangent = Math.max((high - low) / 2, (right - left) / 2 / aspect);
    target.copy(
      new THREE.Vector3((left + right) / 2, (low + high) / 2, -1)
        .setLength(camera.position.distanceTo(target))
        .applyMatrix4(camera.matrixWorld),
    );
  }
  return (2 * Math.atan(tangent * 1.07) * 180) / Math.PI;
}

/**
 * The section of a cone of half-angle `angle` (rad) from a head around a target, through the target: a circle, as
 * points.
 * @param {Vector3} head
 * @param {Vector3} target
 * @param {number} angle
 */
export function section(head, target, angle, steps = 72) {
  const axis = target.clone().sub(head),
    radius = axis.length() * Math.tan(angle);
  axis.normalize();
  const side = new THREE.Vector3(0, 0, 1).cross(axis).normalize(),
    up = axis.clone().cross(side);
  return Array.from({ length: steps }, (_, step) => {
    const roll = (step / steps) * 2 * Math.PI;
    return target
      .clone()
      .addScaledVector(side, radius * Math.cos(roll))
      .addScaledVector(up, radius * Math.sin(roll));
  });
}
