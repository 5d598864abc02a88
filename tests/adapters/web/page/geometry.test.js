import assert from "node:assert/strict";
import { test } from "node:test";
import { item, scene, TWINS } from "./scenes.js";
import { frame, outline, place, section, vector } from "#page/geometry.js";
import { wrist } from "#page/pointing.js";
import { PerspectiveCamera, Vector3 } from "#page/vendor/three.module.min.js";

/** @param {number} found @param {number} expected */
const near = (found, expected, within = 1e-9) =>
  assert.ok(Math.abs(found - expected) <= within, `${found} is not ${expected}`);

test("the frame of a table leads from the person to the middle of the items", () => {
  const { middle, ahead, right, height } = frame(TWINS);
  near(middle.distanceTo(new Vector3(-0.1, 2, 0.75)), 0);
  near(ahead.z, 0);
  near(ahead.length(), 1);
  near(ahead.dot(right), 0);
  assert.ok(right.x > 0);
  assert.equal(height, 0.75);
});

test("items beneath the head are ahead of it all the same", () => {
  assert.deepEqual(frame(scene(item("cup", [0, 0, 0.7]))).ahead.toArray(), [0, 1, 0]);
});

test("the outline keeps its margin to every item", () => {
  const points = outline(TWINS, 0.2);
  for (const {
    position: [x, y],
  } of TWINS.items)
    assert.ok(Math.min(...points.map((point) => Math.hypot(point.x - x, point.y - y))) > 0.199);
  near(Math.max(...points.map((point) => point.x)), 0.4, 1e-3);
});

for (const aspect of [0.5, 1, 2.4])
  test(`the camera sees every corner of the table in a picture of shape ${aspect}`, () => {
    const camera = new PerspectiveCamera(40, 1, 0.05, 60),
      head = vector(TWINS.head);
    camera.up.set(0, 0, 1);
    const points = outline(TWINS).map(({ x, y }) => new Vector3(x, y, 0.75));
    place(camera, frame(TWINS), { head, points, aspect });
    for (const point of points) {
      const seen = point.clone().project(camera);
      assert.ok(Math.max(Math.abs(seen.x), Math.abs(seen.y)) <= 1, `${seen.toArray()}`);
    }
    assert.ok(camera.position.y < 2, "from the person's side");
  });

test("the section of a cone has its half-angle all around", () => {
  const head = new Vector3(0, 0, 1.6),
    target = new Vector3(0.3, 2, 0.75),
    way = target.clone().sub(head);
  const points = section(head, target, 0.15);
  for (const point of points) near(point.clone().sub(head).angleTo(way), 0.15);
  near(
    points
      .reduce((sum, point) => sum.add(point), new Vector3())
      .divideScalar(points.length)
      .distanceTo(target),
    0,
  );
});

test("a wrist is an arm's length from the head, on the way to what is pointed at", () => {
  const hand = vector(wrist([0, 0, 1.6], new Vector3(0, 3, 1.6)));
  near(hand.distanceTo(new Vector3(0, 0.6, 1.6)), 0);
});
