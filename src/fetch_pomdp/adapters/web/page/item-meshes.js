// The meshes of what stands on a table: simple shapes and colours, guessed from an item's words.

import * as THREE from "./vendor/three.module.min.js";

/** @import { BufferGeometry, Mesh, Object3D } from "three" */
/** @import { Item } from "./messages.js" */

/** @type {Record<string, number>} */
const COLOURS = {
  black: 0x33373b,
  white: 0xf3f1ec,
  grey: 0x9a9fa3,
  gray: 0x9a9fa3,
  silver: 0xc3c9ce,
  metal: 0xb4bbc1,
  red: 0xc2453a,
  green: 0x3f8f5f,
  blue: 0x3c6ea8,
  yellow: 0xe0b13c,
  orange: 0xd97f35,
  purple: 0x7d5a9c,
  pink: 0xd68aa4,
  brown: 0x8a6343,
  wooden: 0xb98d5c,
  wood: 0xb98d5c,
};
const OTHERS = [0x5b8a8f, 0xb5795a, 0x7a8b4f, 0x8a6a94, 0xc09a4b, 0x587a9e];

/** @param {Item} item */
function colourOf(item) {
  const named = item.vocabulary.find((word) => word in COLOURS);
  if (named) return COLOURS[named];
  const sum = [...item.vocabulary[0]].reduce((total, letter) => total * 31 + letter.charCodeAt(0), 7);
  return OTHERS[Math.abs(sum) % OTHERS.length];
}

/** @param {BufferGeometry} geometry @param {number} colour */
function solid(geometry, colour, metal = 0) {
  const mesh = new THREE.Mesh(
    geometry,
    new THREE.MeshStandardMaterial({
      color: colour,
      roughness: metal ? 0.35 : 0.7,
      metalness: metal,
      side: THREE.DoubleSide,
    }),
  );
  mesh.castShadow = true;
  return mesh;
}

/** A body of revolution. @param {[radius: number, height: number][]} profile m */
function turned(profile) {
  const geometry = new THREE.LatheGeometry(
    profile.map(([radius, height]) => new THREE.Vector2(radius, height)),
    40,
  );
  return geometry.rotateX(Math.PI / 2);
}

/** Each maker returns parts that stand at z = 0, in metres. @type {Record<string, (colour: number) => Object3D[]>} */
const MAKERS = {
  bowl(colour) {
    return [
      solid(
        turned([
          [0, 0.004],
          [0.028, 0.004],
          [0.03, 0],
          [0.05, 0.02],
          [0.062, 0.05],
          [0.058, 0.05],
          [0.046, 0.022],
          [0, 0.012],
        ]),
        colour,
      ),
    ];
  },
  marker(colour) {
    const body = solid(
      new THREE.CylinderGeometry(0.011, 0.011, 0.1, 24).rotateX(Math.PI / 2).translate(0, 0, 0.05),
      0xf1efe9,
    );
    const cap = solid(
      new THREE.CylinderGeometry(0.0125, 0.0125, 0.045, 24).rotateX(Math.PI / 2).translate(0, 0, 0.115),
      colour,
    );
    const foot = solid(
      new THREE.CylinderGeometry(0.0125, 0.0125, 0.012, 24).rotateX(Math.PI / 2).translate(0, 0, 0.006),
      colour,
    );
    return [body, cap, foot];
  },
  spoon(colour) {
    const handle = solid(new THREE.CapsuleGeometry(0.006, 0.1, 4, 12).translate(0, 0.035, 0), colour, 0.6);
    const head = solid(
      new THREE.SphereGeometry(0.026, 24, 16).scale(0.85, 1.25, 0.35).translate(0, -0.045, 0),
      colour,
      0.6,
    );
    const spoon = new THREE.Group().add(handle, head);
    spoon.position.z = 0.011;
    spoon.rotation.z = -0.5;
    return [spoon];
  },
  cup(colour) {
    const wall = solid(
      turned([
        [0, 0],
        [0.036, 0],
        [0.04, 0.09],
        [0.036, 0.09],
        [0.033, 0.008],
        [0, 0.008],
      ]),
      colour,
    );
    const ear = solid(
      new THREE.TorusGeometry(0.024, 0.006, 10, 24).rotateX(Math.PI / 2).translate(0.045, 0, 0.047),
      colour,
    );
    return [wall, ear];
  },
  bottle(colour) {
    return [
      solid(
        turned([
          [0, 0],
          [0.033, 0],
          [0.034, 0.11],
          [0.014, 0.15],
          [0.014, 0.19],
          [0, 0.19],
        ]),
        colour,
      ),
    ];
  },
  ball(colour) {
    return [solid(new THREE.SphereGeometry(0.042, 32, 20).translate(0, 0, 0.042), colour)];
  },
  plate(colour) {
    return [
      solid(
        turned([
          [0, 0.002],
          [0.05, 0.002],
          [0.085, 0.016],
          [0.084, 0.019],
          [0.05, 0.007],
          [0, 0.007],
        ]),
        colour,
      ),
    ];
  },
  block(colour) {
    return [solid(new THREE.BoxGeometry(0.07, 0.07, 0.07).translate(0, 0, 0.035), colour)];
  },
};
/** @type {Record<string, string>} */
const NAMES = {
  pen: "marker",
  pencil: "marker",
  expo: "marker",
  mug: "cup",
  glass: "cup",
  ladle: "spoon",
  fork: "spoon",
  knife: "spoon",
  whisk: "spoon",
  utensil: "spoon",
  screwdriver: "marker",
  apple: "ball",
  orange: "ball",
  dish: "plate",
  box: "block",
  book: "block",
  can: "bottle",
  jar: "bottle",
  container: "bowl",
};

/** @param {Item} item */
export function itemMesh(item) {
  const words = [...item.vocabulary, ...item.id.toLowerCase().split(/[^a-z]+/)];
  const found = words.map((word) => (word in MAKERS ? word : NAMES[word])).find(Boolean) ?? "block";
  const group = new THREE.Group().add(...MAKERS[found](colourOf(item)));
  group.position.set(...item.position);
  group.userData.top = new THREE.Box3().setFromObject(group).max.z - item.position[2];
  return group;
}

/** Free what the graphics card keeps of an object. @param {Object3D} object */
export function dispose(object) {
  object.traverse((part) => {
    if (!(part instanceof THREE.Mesh)) return;
    part.geometry.dispose();
    part.material.dispose();
  });
}
