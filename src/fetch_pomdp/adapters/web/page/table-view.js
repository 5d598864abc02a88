// The table in 3-D from the person's side, and the robot across it.

import * as THREE from "./vendor/three.module.min.js";
import { frame, outline, place, section, vector } from "./geometry.js";
import { Robot } from "./robot.js";
import { dispose, thing } from "./item-meshes.js";

const ACCENT = 0x1d6f6a, RING = 0xc2410c;
const still = matchMedia("(prefers-reduced-motion: reduce)");
const BEHIND = 0.4; // m, of the robot's middle beyond the table's edge
const TABLE = 0.04; // m thick

export class Stage {
  #last = performance.now();
  #busy = false;
  #steps = []; // movements to come: [time, what to do]

  constructor(canvas, drawn) {
    this.drawn = drawn; // called after each picture
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.toneMapping = THREE.NeutralToneMapping;
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.05, 60);
    this.camera.up.set(0, 0, 1);
    this.world = new THREE.Scene();
    this.light = new THREE.DirectionalLight(0xfff6ea, 1.7);
    this.fill = new THREE.DirectionalLight(0xf2f6ff, 1.1); // from the person's side, without a shadow
    this.light.castShadow = true;
    this.light.shadow.mapSize.set(2048, 2048);
    this.light.shadow.radius = 5;
    this.light.shadow.normalBias = 0.01;
    this.world.add(new THREE.HemisphereLight(0xffffff, 0xdcd8d2, 1.7), this.light, this.light.target, this.fill, this.fill.target);
    this.robot = new Robot();
    this.ring = new THREE.Mesh(new THREE.RingGeometry(0.068, 0.08, 64), new THREE.MeshBasicMaterial({ color: RING }));
    this.ring.visible = false;
    this.world.add(this.ring);
    this.#pointer();
    new ResizeObserver(() => this.#resize()).observe(canvas);
    setInterval(() => this.#blink(), 4300);
  }

  // Set the table.
  set(scene) {
    if (this.table) {
      this.world.remove(this.table);
      dispose(this.table);
    }
    this.scene = scene;
    this.head = vector(scene.head);
    this.frame = frame(scene);
    this.things = new Map(scene.items.map((item) => [item.id, thing(item)]));
    this.table = new THREE.Group().add(...this.things.values(), ...this.#board(), this.robot.group);
    this.world.add(this.table);
    this.#stand();
    this.rest();
    this.#resize();
  }

  // Lay a ring around the item that the person is to get, for their eyes alone; null takes it away.
  encircle(id) {
    this.ring.visible = id !== null;
    if (id) this.ring.position.copy(this.things.get(id).position).add(new THREE.Vector3(0, 0, 0.003));
    this.draw();
  }

  // Move one item, while a table is edited.
  put(id, position) {
    this.things.get(id)?.position.set(...position);
    this.draw();
  }

  #board() {
    const shape = new THREE.Shape(outline(this.scene));
    const bevel = 0.008;
    const top = new THREE.Mesh(
      new THREE.ExtrudeGeometry(shape, { depth: TABLE - 2 * bevel, bevelSize: bevel, bevelThickness: bevel, bevelSegments: 4 }).translate(0, 0, this.frame.height - TABLE + bevel),
      new THREE.MeshStandardMaterial({ color: 0xd9c3a2, roughness: 0.75 }),
    );
    top.receiveShadow = top.castShadow = true;
    const floor = new THREE.Mesh(new THREE.CircleGeometry(9, 64), new THREE.ShadowMaterial({ opacity: 0.16 }));
    floor.position.copy(this.frame.middle).setZ(0);
    floor.receiveShadow = true;
    const leg = new THREE.Mesh(new THREE.CylinderGeometry(0.07, 0.13, this.frame.height, 32).rotateX(Math.PI / 2), new THREE.MeshStandardMaterial({ color: 0x8d8377, roughness: 0.8 }));
    leg.position.copy(this.frame.middle).setZ(this.frame.height / 2 - TABLE);
    return [top, floor, leg];
  }

  #stand() {
    const { ahead, right, middle, height } = this.frame;
    const edge = Math.max(...outline(this.scene).map((point) => point.x * ahead.x + point.y * ahead.y));
    const place = middle.clone().addScaledVector(ahead, edge + BEHIND - middle.dot(ahead)).setZ(height - 0.75);
    this.robot.group.position.copy(place);
    this.robot.group.rotation.z = Math.atan2(ahead.y, ahead.x) - Math.PI / 2;
    this.robot.group.updateMatrixWorld(true);
    const deep = Math.max(...this.scene.items.map((item) => place.clone().sub(vector(item.position)).dot(ahead)));
    this.robot.setReach(Math.max(0.34, (Math.hypot(deep + 0.02, 0.4) - 0.1) / 2 + 0.02));
    this.gaze = place.clone().addScaledVector(ahead, -2).setZ(this.head.z);
    this.right = right;
    this.light.position.copy(middle).addScaledVector(right, -1.6).addScaledVector(ahead, -1.4).setZ(height + 3);
    this.light.target.position.copy(middle);
    this.fill.position.copy(middle).addScaledVector(right, 1.2).addScaledVector(ahead, -3).setZ(height + 1.2);
    this.fill.target.position.copy(place).setZ(height + 0.3);
    const wide = Math.max(1.2, ...this.scene.items.map((item) => vector(item.position).distanceTo(middle) + 0.6));
    Object.assign(this.light.shadow.camera, { left: -wide, right: wide, top: wide + 0.6, bottom: -wide, near: 0.5, far: 8 });
    this.light.shadow.camera.updateProjectionMatrix();
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    if (!this.scene || !width || !height) return;
    this.renderer.setSize(width, height, false);
    const at = this.robot.group.position, { right } = this.frame;
    const points = outline(this.scene).filter((_, index) => index % 6 === 0).map((point) => new THREE.Vector3(point.x, point.y, this.frame.height - 0.09));
    for (const side of [-0.42, 0.42]) points.push(at.clone().addScaledVector(right, side).setZ(at.z + 1.74));
    place(this.camera, this.frame, this.head, points, width / height);
    this.draw();
  }

  // What the robot does: each with an item's id.

  ask(id) {
    const { arm, above } = this.#turn(id);
    const item = vector(this.scene.items.find((each) => each.id === id).position);
    this.#then(0, () => {
      const goal = this.robot.local(item);
      const way = goal.clone().setZ(goal.z + 0.05).sub(arm.shoulder);
      arm.target.copy(arm.shoulder).addScaledVector(way.clone().normalize(), Math.min(arm.reach * 0.97, way.length() - 0.24));
      arm.target.z = Math.max(arm.target.z, goal.z + 0.2);
      arm.aim = this.robot.local(above);
      arm.pointing = 1;
      arm.grip = 0;
    });
  }

  fetch(id) {
    const { arm, above } = this.#turn(id);
    const object = this.things.get(id), home = object.position.clone(), top = object.userData.top;
    const down = above.clone().setZ(home.z + top * 0.6 + 0.075);
    const to = (point) => () => {
      arm.target.copy(this.robot.local(point));
      arm.aim = this.robot.local(point.clone().setZ(point.z - 1));
    };
    const over = above.clone().setZ(home.z + top + 0.22);
    this.#then(0, () => { to(over)(); arm.grip = 1; });
    this.#then(0.75, to(down));
    this.#then(1.2, () => { arm.grip = 0.35; this.held = { object, arm, home, below: down.z - home.z }; });
    this.#then(1.25, to(over.clone().setZ(over.z + 0.1)));
    const near = Math.max(arm.reach * 0.93, 0.3);
    this.#then(1.75, () => {
      arm.target.copy(arm.shoulder).add(new THREE.Vector3(-0.35 * arm.side, -1, -0.06).setLength(near));
      arm.aim = arm.target.clone().add(new THREE.Vector3(0, -0.4, -1));
      this.robot.gaze.copy(this.gaze);
    });
  }

  // Let go of everything, also of what is in the hand.
  rest() {
    this.#steps = [];
    if (this.held) this.held.object.position.copy(this.held.home);
    this.held = null;
    for (const arm of this.robot.arms) Object.assign(arm, { aim: null, pointing: 0, grip: 1, target: arm.rest.clone() });
    this.robot.gaze.copy(this.gaze ?? this.robot.gaze);
    this.draw();
  }

  // Turn to an item, with the arm on its side.
  #turn(id) {
    this.rest();
    const item = vector(this.scene.items.find((each) => each.id === id).position);
    const across = item.clone().sub(this.frame.middle).dot(this.right);
    const arm = this.robot.arms[across > 0 ? 1 : 0];
    this.robot.glideTarget = Math.sign(across) * Math.max(0, Math.abs(across) - 0.3);
    this.robot.gaze.copy(item);
    return { arm, above: item.clone().setZ(item.z + 0.03) };
  }

  #then(after, act) {
    this.#steps.push([performance.now() + (still.matches ? 0 : after * 1000), act]);
    this.draw();
  }

  // The person's pointing.

  #pointer() {
    const soft = (opacity) => new THREE.MeshBasicMaterial({ color: ACCENT, transparent: true, opacity, depthTest: false, side: THREE.DoubleSide });
    this.areas = [2, 1].map((sigmas) => Object.assign(new THREE.Mesh(new THREE.BufferGeometry(), soft(0.09)), { sigmas }));
    this.beam = new THREE.Mesh(new THREE.CylinderGeometry(0.003, 0.005, 1, 12).translate(0, 0.5, 0), soft(0.55));
    this.mark = new THREE.Mesh(new THREE.RingGeometry(0.016, 0.024, 40), soft(0.9));
    this.pointing = new THREE.Group().add(...this.areas, this.beam, this.mark);
    this.pointing.visible = false;
    this.pointing.renderOrder = 5;
    this.world.add(this.pointing);
  }

  // Where the table is at a place of the picture (pixels), or what is behind it.
  at(x, y) {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.camera);
    const found = ray.intersectObjects([...this.things.values()])[0]?.point;
    const board = new THREE.Plane(new THREE.Vector3(0, 0, 1), -this.frame.height);
    const wall = new THREE.Plane().setFromNormalAndCoplanarPoint(this.frame.ahead, this.robot.group.position);
    const hit = ray.ray.intersectPlane(board, new THREE.Vector3()), behind = ray.ray.intersectPlane(wall, new THREE.Vector3());
    return found ?? (hit && (!behind || hit.distanceTo(this.camera.position) < behind.distanceTo(this.camera.position)) ? hit : behind);
  }

  // Show pointing at a target (Vector3), with the noise that the model expects; null ends it.
  point(target) {
    this.pointing.visible = target !== null;
    if (target) {
      for (const area of this.areas) {
        area.geometry.dispose();
        area.geometry = new THREE.BufferGeometry().setFromPoints(fan(section(this.head, target, area.sigmas * this.scene.sigma)));
      }
      // From the head itself it would be seen as a dot; it comes from beneath the picture instead.
      const hand = this.camera.position.clone().addScaledVector(this.frame.ahead, 0.35).addScaledVector(this.right, 0.12);
      hand.z -= 0.36;
      const way = target.clone().sub(hand);
      this.beam.position.copy(hand);
      this.beam.scale.set(1, way.length(), 1);
      this.beam.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.normalize());
      this.mark.position.copy(target).add(new THREE.Vector3(0, 0, 0.004));
      this.robot.gaze.copy(target);
    } else if (!this.#steps.length) this.robot.gaze.copy(this.gaze);
    this.draw();
  }

  // Where a point of the world is in the picture (pixels).
  seen(point) {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    const at = point.clone().project(this.camera);
    return { x: ((at.x + 1) / 2) * width, y: ((1 - at.y) / 2) * height };
  }

  mouth() {
    return this.robot.head.getWorldPosition(new THREE.Vector3()).add(new THREE.Vector3(0, 0, 0.1));
  }

  // Pictures are drawn only while something changes.

  draw() {
    if (this.#busy) return;
    this.#busy = true;
    this.#last = performance.now();
    requestAnimationFrame((now) => this.#tick(now));
  }

  #tick(now) {
    const seconds = Math.min(Math.max(now - this.#last, 0) / 1000, 0.1);
    this.#last = now;
    while (this.#steps.length && this.#steps[0][0] <= now) this.#steps.shift()[1]();
    const moving = this.robot.step(still.matches ? 1 : 1 - Math.exp(-6.5 * seconds), this.blinking);
    if (this.held) {
      const hand = this.robot.body.localToWorld(this.held.arm.hand.clone());
      this.held.object.position.copy(hand).setZ(hand.z - this.held.below);
    }
    this.renderer.render(this.world, this.camera);
    this.drawn();
    this.#busy = moving || this.#steps.length > 0;
    if (this.#busy) requestAnimationFrame((next) => this.#tick(next));
  }

  #blink() {
    if (still.matches || document.hidden) return;
    this.blinking = true;
    this.draw();
    setTimeout(() => { this.blinking = false; this.draw(); }, 130);
  }
}

function fan(points) {
  const middle = points.reduce((sum, point) => sum.add(point), new THREE.Vector3()).divideScalar(points.length);
  return points.flatMap((point, index) => [middle, point, points[(index + 1) % points.length]]);
}
