// What the page's modules ask of a browser when they are loaded, for Node; imported before them.

import { readFileSync } from "node:fs";

export const PAGE = new URL("../../../../src/fetch_pomdp/adapters/web/page/", import.meta.url);
/** @type {Record<string, Record<string, string>>} */
export const TEXTS = JSON.parse(readFileSync(new URL("texts.json", PAGE), "utf8"));

/** A Storage that a test begins with empty. */
class MemoryStorage {
  #kept = new Map();
  /** @param {string} key */
  getItem(key) {
    return this.#kept.get(key) ?? null;
  }
  /** @param {string} key @param {string} value */
  setItem(key, value) {
    this.#kept.set(key, String(value));
  }
  /** @param {string} key */
  removeItem(key) {
    this.#kept.delete(key);
  }
}

/** Let a test begin as a page does that was just opened. @param {string} address */
export function open(address = "http://robot.test/") {
  const parts = {
    localStorage: new MemoryStorage(),
    sessionStorage: new MemoryStorage(),
    location: new URL(address),
    navigator: { language: "en-GB" },
    document: { documentElement: {}, querySelectorAll: () => [] },
    fetch: async () => ({ json: async () => structuredClone(TEXTS) }),
  };
  for (const [name, value] of Object.entries(parts))
    Object.defineProperty(globalThis, name, { value, configurable: true, writable: true });
}

open();
