// The table in 3-D from the person's side, with the robot across it, and where in the picture things are.

import * as THREE from "./vendor/three.module.min.js";
import { frame, outline, place, section, vector } from "./geometry.js";
import { dispose, itemMesh } from "./item-meshes.js";
import { reducedMotion, RobotMotion } from "./robot-motion.js";
import { Robot } from "./robot.js";

/** @import { Group, Vector3 } from "three" */
/** @import { Frame } from "./geometry.js" */
/** @import { Point3, Scene } from "./messages.js" */
/**
 * @typedef {{ scene: Scene, frame: Frame, head: Vector3, meshes: Map<string, Group>, group: Group }} Table what is
 *   shown
 */

const ACCENT = 0x1d6f6a,
  RING = 0xc2410c;
const TABLE = 0.04; // m thick
const BLINK = { every: 4300, length: 130 }; // ms

export class TableView {
  #last = performance.now();
  #busy = false;
  #blinking = false;
  /** @type {Table | null} */
  #table = null;
  #robot = new Robot();
  #cone = new PointingCone();
  #ring = new THREE.Mesh(new THREE.RingGeometry(0.068, 0.08, 64), new THREE.MeshBasicMaterial({ color: RING }));
  #world = new THREE.Scene();
  #camera = new THREE.PerspectiveCamera(40, 1, 0.05, 60);
  #lights = new Lights();

  /** Throws without WebGL. @param {HTMLCanvasElement} canvas @param {() => void} onDrawn called after each picture */
  constructor(canvas, onDrawn) {
    this.onDrawn = onDrawn;
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.toneMapping = THREE.NeutralToneMapping;
    this.robot = new RobotMotion(this.#robot, () => this.draw());
    this.#camera.up.set(0, 0, 1);
    this.#ring.visible = false;
    this.#world.add(...this.#lights.all, this.#ring, this.#cone.group);
    new ResizeObserver(() => this.#resize()).observe(canvas);
    setInterval(() => this.#blink(), BLINK.every);
  }

  /** The table that is shown. Throws before there is one. */
  get table() {
    if (!this.#table) throw new TypeError("found no table, expected that one was set");
    return this.#table;
  }

  /** Set the table. @param {Scene} scene */
  set(scene) {
    if (this.#table) {
      this.#world.remove(this.#table.group);
      dispose(this.#table.group);
    }
    const found = frame(scene),
      meshes = new Map(scene.items.map((item) => [item.id, itemMesh(item)]));
    const group = new THREE.Group().add(...meshes.values(), ...furniture(scene, found), this.#robot.group);
    this.#table = { scene, frame: found, head: vector(scene.head), meshes, group };
    this.#world.add(group);
    this.robot.stand(this.#table);
    this.#lights.aim(scene, found, this.#robot.group.position);
    this.#resize();
  }

  /** Lay a ring around the item that the person is to get, for their eyes alone. @param {string} id */
  encircle(id) {
    const mesh = this.table.meshes.get(id);
    this.#ring.visible = mesh !== undefined;
    if (mesh) this.#ring.position.copy(mesh.position).add(new THREE.Vector3(0, 0, 0.003));
    this.draw();
  }

  /** Move one item, while a table is edited. @param {string} id @param {Point3} position */
  put(id, position) {
    this.table.meshes.get(id)?.position.set(...position);
    this.draw();
  }

  /** Show pointing, with the noise that the model expects; null ends it. @param {Vector3 | null} target */
  point(target) {
    if (target) this.#cone.show(target, this.table, this.#camera);
    else this.#cone.group.visible = false;
    this.robot.look(target);
    this.draw();
  }

  /**
   * Where the table is at a place of the picture (pixels), or what is behind it.
   * @param {number} x
   * @param {number} y
   */
  at(x, y) {
    const { clientWidth: width, clientHeight: height } = this.canvas,
      {
        meshes,
        frame: { ahead, height: level },
      } = this.table;
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.#camera);
    const found = caster.intersectObjects([...meshes.values()])[0]?.point;
    const board = new THREE.Plane(new THREE.Vector3(0, 0, 1), -level);
    const wall = new THREE.Plane().setFromNormalAndCoplanarPoint(ahead, this.#robot.group.position);
    const hit = caster.ray.intersectPlane(board, new THREE.Vector3()),
      behind = caster.ray.intersectPlane(wall, new THREE.Vector3());
    const { position: eye } = this.#camera;
    return found ?? (hit && (!behind || hit.distanceTo(eye) < behind.distanceTo(eye)) ? hit : behind);
  }

  /** Where a point of the world is in the picture (pixels). @param {Vector3} point */
  seen(point) {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const at = point.clone().project(this.#camera);
    return { x: ((at.x + 1) / 2) * width, y: ((1 - at.y) / 2) * height };
  }

  /** Where the foot and the top of an item are in the picture (pixels). @param {string} id */
  extent(id) {
    const mesh = this.table.meshes.get(id);
    if (!mesh) throw new RangeError(`found ${id}, expected an item of the table`);
    const { position } = mesh;
    return { foot: this.seen(position), head: this.seen(position.clone().setZ(position.z + mesh.userData.top)) };
  }

  /** Where the robot's words come from, in the picture (pixels). */
  mouth() {
    return this.seen(this.#robot.head.getWorldPosition(new THREE.Vector3()).add(new THREE.Vector3(0, 0, 0.1)));
  }

  /** Draw a picture, and on as long as something moves. */
  draw() {
    if (this.#busy) return;
    this.#busy = true;
    this.#last = performance.now();
    requestAnimationFrame((now) => this.#tick(now));
  }

  /** @param {number} now ms */
  #tick(now) {
    const seconds = Math.min(Math.max(now - this.#last, 0) / 1000, 0.1);
    this.#last = now;
    const moving = this.robot.step(now, seconds, this.#blinking);
    this.renderer.render(this.#world, this.#camera);
    this.onDrawn();
    this.#busy = moving;
    if (this.#busy) requestAnimationFrame((next) => this.#tick(next));
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!this.#table || !width || !height) return;
    this.renderer.setSize(width, height, false);
    const { scene, frame: found, head } = this.#table,
      at = this.#robot.group.position;
    const points = outline(scene)
      .filter((_, index) => index % 6 === 0)
      .map((point) => new THREE.Vector3(point.x, point.y, found.height - 0.09));
    for (const side of [-0.42, 0.42])
      points.push(
        at
          .clone()
          .addScaledVector(found.right, side)
          .setZ(at.z + 1.74),
      );
    place(this.#camera, found, { head, points, aspect: width / height });
    this.draw();
  }

  #blink() {
    if (reducedMotion.matches || document.hidden) return;
    this.#blinking = true;
    this.draw();
    setTimeout(() => {
      this.#blinking = false;
      this.draw();
    }, BLINK.length);
  }
}

/** The board, its leg, and the shadow on the floor. @param {Scene} scene @param {Frame} frame */
function furniture(scene, { middle, height }) {
  const bevel = 0.008;
  const top = new THREE.Mesh(
    new THREE.ExtrudeGeometry(new THREE.Shape(outline(scene)), {
      depth: TABLE - 2 * bevel,
      bevelSize: bevel,
      bevelThickness: bevel,
      bevelSegments: 4,
    }).translate(0, 0, height - TABLE + bevel),
    new THREE.MeshStandardMaterial({ color: 0xd9c3a2, roughness: 0.75 }),
  );
  top.receiveShadow = top.castShadow = true;
  const floor = new THREE.Mesh(new THREE.CircleGeometry(9, 64), new THREE.ShadowMaterial({ opacity: 0.16 }));
  floor.position.copy(middle).setZ(0);
  floor.receiveShadow = true;
  const leg = new THREE.Mesh(
    new THREE.CylinderGeometry(0.07, 0.13, height, 32).rotateX(Math.PI / 2),
    new THREE.MeshStandardMaterial({ color: 0x8d8377, roughness: 0.8 }),
  );
  leg.position.copy(middle).setZ(height / 2 - TABLE);
  return [top, floor, leg];
}

class Lights {
  #sun = new THREE.DirectionalLight(0xfff6ea, 1.7);
  #fill = new THREE.DirectionalLight(0xf2f6ff, 1.1); // from the person's side, without a shadow

  constructor() {
    this.#sun.castShadow = true;
    this.#sun.shadow.mapSize.set(2048, 2048);
    this.#sun.shadow.radius = 5;
    this.#sun.shadow.normalBias = 0.01;
    this.all = [
      new THREE.HemisphereLight(0xffffff, 0xdcd8d2, 1.7),
      this.#sun,
      this.#sun.target,
      this.#fill,
      this.#fill.target,
    ];
  }

  /** Light a table, and the robot where it stands. @param {Scene} scene @param {Frame} frame @param {Vector3} robot */
  aim(scene, { middle, ahead, right, height }, robot) {
    this.#sun.position
      .copy(middle)
      .addScaledVector(right, -1.6)
      .addScaledVector(ahead, -1.4)
      .setZ(height + 3);
    this.#sun.target.position.copy(middle);
    this.#fill.position
      .copy(middle)
      .addScaledVector(right, 1.2)
      .addScaledVector(ahead, -3)
      .setZ(height + 1.2);
    this.#fill.target.position.copy(robot).setZ(height + 0.3);
    const wide = Math.max(1.2, ...scene.items.map((item) => vector(item.position).distanceTo(middle) + 0.6));
    Object.assign(this.#sun.shadow.camera, {
      left: -wide,
      right: wide,
      top: wide + 0.6,
      bottom: -wide,
      near: 0.5,
      far: 8,
    });
    this.#sun.shadow.camera.updateProjectionMatrix();
  }
}

/** Where the person points: a beam, a mark, and the sections of the model's cone one and two sigma wide. */
class PointingCone {
  #areas = [2, 1].map((sigmas) => ({ sigmas, mesh: new THREE.Mesh(new THREE.BufferGeometry(), soft(0.09)) }));
  #beam = new THREE.Mesh(new THREE.CylinderGeometry(0.003, 0.005, 1, 12).translate(0, 0.5, 0), soft(0.55));
  #mark = new THREE.Mesh(new THREE.RingGeometry(0.016, 0.024, 40), soft(0.9));

  constructor() {
    this.group = new THREE.Group().add(...this.#areas.map(({ mesh }) => mesh), this.#beam, this.#mark);
    this.group.visible = false;
    this.group.renderOrder = 5;
  }

  /** @param {Vector3} target @param {Table} table @param {THREE.PerspectiveCamera} camera */
  show(target, { head, scene, frame: { ahead, right } }, camera) {
    this.group.visible = true;
    for (const { sigmas, mesh } of this.#areas) {
      mesh.geometry.dispose();
      mesh.geometry = new THREE.BufferGeometry().setFromPoints(fan(section(head, target, sigmas * scene.sigma)));
    }
    // From the head itself it would be seen as a dot; it comes from beneath the picture instead.
    const hand = camera.position.clone().addScaledVector(ahead, 0.35).addScaledVector(right, 0.12);
    hand.z -= 0.36;
    const way = target.clone().sub(hand);
    this.#beam.position.copy(hand);
    this.#beam.scale.set(1, way.length(), 1);
    this.#beam.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), way.normalize());
    this.#mark.position.copy(target).add(new THREE.Vector3(0, 0, 0.004));
  }
}

/** @param {number} opacity */
function soft(opacity) {
  return new THREE.MeshBasicMaterial({
    color: ACCENT,
    transparent: true,
    opacity,
    depthTest: false,
    side: THREE.DoubleSide,
  });
}

/** Triangles between neighbours of a ring of points and its middle. @param {Vector3[]} points */
function fan(points) {
  const middle = points.reduce((sum, point) => sum.add(point), new THREE.Vector3()).divideScalar(points.length);
  return points.flatMap((point, index) => [middle, point, points[(index + 1) % points.length]]);
}
