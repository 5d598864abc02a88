import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { open } from "./browser.js";
import { acted, leaders } from "#page/panels.js";
import { setLanguage } from "#page/texts.js";

beforeEach(() => {
  open();
  setLanguage("en");
});

test("the likeliest item leads alone when it is twice as likely as any other", () => {
  assert.equal(leaders({ cup: 0.7, pot: 0.2, pan: 0.1 }), "now most likely: cup 70%");
});

test("others lead with it, the likeliest first", () => {
  assert.equal(leaders({ cup: 0.35, pot: 0.4, pan: 0.25 }), "now most likely: pot 40%, cup 35%, and pan 25%");
});

test("of many, three are named", () => {
  assert.equal(
    leaders({ a: 0.22, b: 0.21, c: 0.2, d: 0.19, e: 0.18 }),
    "now most likely: a 22%, b 21%, c 20%, and 2 more",
  );
});

test("what the robot could not do is told with its reason, where it knows one", () => {
  /** @type {import("#page/messages.js").Acted} */
  const failed = { type: "action", action: "pick", item: "cup-1", outcome: "failed" };
  assert.match(acted(failed), /cup-1.*: it failed$/);
  assert.match(acted({ ...failed, reason: "blocked by cup-2" }), /cup-1.*: it failed \(blocked by cup-2\)$/);
});
