// Finds a person's joints in pictures, in a thread of its own. Takes an ImageBitmap, answers with the joints in it or null.
// It is served with a policy of its own, which lets it compile WebAssembly; the page itself may not.

const FOLDER = new URL("vendor/pose/", location.href);

// The library loads its model only where there is a window. What it asks of one: a script element, and a canvas.
self.window = self;
self.document = {
  body: { appendChild: (script) => { importScripts(script.src); script.load(); } },
  createElement: (name) => (name === "canvas" ? new OffscreenCanvas(1, 1) : {
    setAttribute(key, value) { this[key] = value; },
    addEventListener(kind, call) { this[kind] = call; },
  }),
};
importScripts("vendor/pose/pose.js");

const pose = new Pose({ locateFile: (name) => new URL(name, FOLDER).href });
// On the processor: as fast as most graphics cards at this size of model, and as fast where there is none.
pose.setOptions({ modelComplexity: 0, smoothLandmarks: true, useCpuInference: true });
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
