// Finds a person's joints in pictures, in a thread of its own. Takes an ImageBitmap, answers with the joints in it or
// null.
// It is served with a policy of its own, which lets it compile WebAssembly; the page itself may not.

const FOLDER = new URL("vendor/pose/", location.href);

// The library loads its model only where there is a window. What it asks of one: a script element, and a canvas.
/** @returns {Record<string, unknown>} */
const script = () => ({
  /** @this {Record<string, unknown>} @param {string} key @param {unknown} value */
  setAttribute(key, value) {
    this[key] = value;
  },
  /** @this {Record<string, unknown>} @param {string} kind @param {() => void} call */
  addEventListener(kind, call) {
    this[kind] = call;
  },
});
Object.assign(self, {
  window: self,
  document: {
    /** @param {string} name */
    createElement: (name) => (name === "canvas" ? new OffscreenCanvas(1, 1) : script()),
    body: {
      /** @param {{ src: string, load: () => void }} element */
      appendChild(element) {
        importScripts(element.src);
        element.load();
      },
    },
  },
});
importScripts("vendor/pose/pose.js");

const pose = new Pose({ locateFile: (name) => new URL(name, FOLDER).href });
// On the processor: as fast as most graphics cards at this size of model, and as fast where there is none.
pose.setOptions({ modelComplexity: 0, smoothLandmarks: true, useCpuInference: true });
/** @type {Joint[] | null} */
let joints = null;
pose.onResults(({ image, poseLandmarks }) => {
  image.close?.();
  joints = poseLandmarks ?? null;
});

self.onmessage = async ({ data: picture }) => {
  try {
    await pose.send({ image: picture });
    self.postMessage({ joints });
  } catch (error) {
    self.postMessage({ error: String(error) });
  }
  picture.close();
};
