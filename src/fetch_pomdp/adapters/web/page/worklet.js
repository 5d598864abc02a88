// Sound of any rate to 16 kHz, 16-bit PCM, in chunks of 40 ms. Runs in the audio thread.

const RATE = 16000;
const CHUNK = 640; // samples

class Pcm extends AudioWorkletProcessor {
  #filled = 0;
  #chunk = new Int16Array(CHUNK);
  #next = 0; // where the next sample of ours is, in samples of theirs from the start of the block
  #before = 0; // the last sample of the block before
  #low = 0;

  /** Take a block of the first input's first channel; true asks for more. @param {Float32Array[][]} inputs */
  process([[block]]) {
    if (!block) return true;
    const step = sampleRate / RATE;
    const smooth = Math.min(1, 1 - Math.exp((-2 * Math.PI * 7200) / sampleRate)); // nothing above what 16 kHz can hold
    const filtered = block.map((sample) => (this.#low += smooth * (sample - this.#low)));
    for (; this.#next <= filtered.length - 1; this.#next += step) {
      const left = Math.floor(this.#next),
        share = this.#next - left;
      const from = left < 0 ? this.#before : filtered[left];
      this.#put(from + share * (filtered[Math.min(left + 1, filtered.length - 1)] - from));
    }
    this.#next -= filtered.length;
    this.#before = filtered[filtered.length - 1];
    return true;
  }

  /** @param {number} sample from -1 to 1 */
  #put(sample) {
    this.#chunk[this.#filled] = Math.max(-1, Math.min(1, sample)) * 32767;
    this.#filled += 1;
    if (this.#filled < CHUNK) return;
    this.port.postMessage(this.#chunk.buffer, [this.#chunk.buffer]);
    this.#chunk = new Int16Array(CHUNK);
    this.#filled = 0;
  }
}

registerProcessor("pcm", Pcm);
