// Tables for tests.

/** @import { Item, Point3, Scene } from "#page/messages.js" */

/** @param {string} id @param {Point3} position @returns {Item} */
export const item = (id, position) => ({ id, position, vocabulary: [id.split("-")[0]] });

/** Items before a head that looks along y. @param {Item[]} items @returns {Scene} */
export const scene = (...items) => ({ items, head: [0, 0, 1.6], sigma: 0.15, threshold: 0.7 });

export const TWINS = scene(
  item("bowl-1", [-0.4, 2, 0.75]),
  item("marker-1", [-0.1, 2, 0.75]),
  item("marker-2", [0.2, 2, 0.75]),
);
