// What items are called where their ids say too much: by their kind, and by where they are beside their like.

import { frame, vector } from "./geometry.js";
import { text } from "./texts.js";

export const kind = (item) => item.id.replace(/[-_ ]?\d+$/, "") || item.id;

// An item in words, as "the marker on the left".
export function described(item, scene) {
  const alike = scene.items.filter((each) => kind(each) === kind(item));
  if (alike.length === 1) return text("item_only", { kind: kind(item) });
  const { right, ahead } = frame(scene);
  const along = (way) => (each) => vector(each.position).dot(way);
  const spread = (way) => Math.max(...alike.map(along(way))) - Math.min(...alike.map(along(way)));
  const sideways = spread(right) >= spread(ahead), way = sideways ? right : ahead;
  const sorted = [...alike].sort((one, other) => along(way)(one) - along(way)(other)), place = sorted.indexOf(item);
  if (alike.length === 2) return text(`item_${sideways ? ["left", "right"][place] : ["near", "far"][place]}`, { kind: kind(item) });
  return text(sideways ? "item_from_left" : "item_from_near", { kind: kind(item), place: place + 1, of: alike.length });
}
