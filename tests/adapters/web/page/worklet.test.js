import assert from "node:assert/strict";
import { test } from "node:test";

/** @typedef {{ process: (inputs: Float32Array[][]) => boolean, port: { sent: Int16Array[] } }} Processor */
/** @type {(new () => Processor)[]} */
const registered = [];
Object.assign(globalThis, {
  sampleRate: 48000,
  AudioWorkletProcessor: class {
    port = {
      /** @type {Int16Array[]} */
      sent: [],
      /** @param {ArrayBuffer} buffer */
      postMessage(buffer) {
        this.sent.push(new Int16Array(buffer));
      },
    };
  },
  /** @param {string} _ @param {new () => Processor} processor */
  registerProcessor: (_, processor) => registered.push(processor),
});
// @ts-expect-error the worklet exports nothing: it registers itself
await import("#page/worklet.js");
const [Pcm] = registered;

/**
 * What is sent of a tone.
 * @param {number} rate
 * @param {{ frequency: number, amplitude?: number, seconds?: number }} tone
 */
function sent(rate, { frequency, amplitude = 0.5, seconds = 1 }) {
  Object.assign(globalThis, { sampleRate: rate });
  const processor = new Pcm();
  const sound = Float32Array.from(
    { length: rate * seconds },
    (_, index) => amplitude * Math.sin((2 * Math.PI * frequency * index) / rate),
  );
  for (let at = 0; at < sound.length; at += 128)
    assert.equal(processor.process([[sound.subarray(at, at + 128)]]), true);
  return processor.port.sent;
}

for (const rate of [16000, 44100, 48000, 96000])
  test(`a second at ${rate} Hz becomes a second at 16 kHz, in chunks of 40 ms`, () => {
    const chunks = sent(rate, { frequency: 440 });
    assert.ok(chunks.every((chunk) => chunk.length === 640));
    assert.ok(Math.abs(chunks.length - 25) <= 1, `${chunks.length} chunks`);
  });

for (const rate of [16000, 44100, 48000])
  test(`a tone at ${rate} Hz keeps its pitch and loudness`, () => {
    const samples = sent(rate, { frequency: 440 })
      .flatMap((chunk) => [...chunk])
      .slice(640);
    const crossings = samples.filter((sample, index) => index > 0 && samples[index - 1] < 0 && sample >= 0).length;
    assert.ok(Math.abs((crossings * 16000) / samples.length - 440) < 3);
    assert.ok(Math.abs(Math.max(...samples) - 0.5 * 32767) < 0.02 * 32767);
  });

test("what 16 kHz cannot hold is quieter", () => {
  const loudest = (/** @type {number} */ frequency) =>
    Math.max(...sent(48000, { frequency }).flatMap((chunk) => [...chunk]));
  assert.ok(loudest(15000) < 0.6 * loudest(1000));
});

test("what is too loud is clipped, and does not wrap around", () => {
  const samples = sent(16000, { frequency: 100, amplitude: 3 }).flatMap((chunk) => [...chunk]);
  assert.equal(Math.max(...samples), 32767);
  assert.equal(Math.min(...samples), -32767);
});

test("an input without sound asks for more", () => {
  assert.equal(new Pcm().process([[]]), true);
});
