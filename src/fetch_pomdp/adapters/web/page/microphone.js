// The person's voice: to the server as sound, or to the browser's own recogniser.

import { find, findAll } from "./dom.js";

/** @import { Connection } from "./connection.js" */
/** @typedef {{ stream: MediaStream, context: AudioContext }} Sound what is open while the server listens */

export class Microphone {
  /** @type {object | null} */
  #wanted = null; // while it is to be open; another each time, so that what opens late knows that it is not
  /** @type {Sound | null} */
  #sound = null;
  /** @type {Recognition | null} */
  #recogniser = null;
  #offered = false;
  #button = find("#microphone", HTMLButtonElement);
  #hold = find("#hold", HTMLInputElement);

  /**
   * @param {Connection} connection
   * @param {(words: string) => void} onHeard called with words that the browser recognised
   * @param {(reason: string) => void} onFail called with why it cannot be used
   */
  constructor(connection, onHeard, onFail) {
    this.connection = connection;
    this.onHeard = onHeard;
    this.onFail = onFail;
    const button = this.#button;
    button.addEventListener("pointerdown", () => {
      if (this.#hold.checked) this.start();
    });
    for (const kind of ["pointerup", "pointerleave"])
      button.addEventListener(kind, () => {
        if (this.#hold.checked) this.stop();
      });
    button.addEventListener("keydown", (event) => {
      if (this.#hold.checked && event.key === " " && !event.repeat) this.start();
    });
    button.addEventListener("keyup", (event) => {
      if (this.#hold.checked && event.key === " ") this.stop();
    });
    button.addEventListener("click", () => {
      if (!this.#hold.checked) this[this.on ? "stop" : "start"]();
    });
    for (const choice of findAll("[name=ears]", HTMLInputElement))
      choice.addEventListener("change", () => this.#choose());
  }

  get on() {
    return this.#wanted !== null;
  }

  /**
   * Offer the ways of recognising speech that there are here; what is open stays open over a new interaction.
   * @param {boolean} server whether it hears
   */
  offer(server) {
    find("#server-ears").hidden = !server || !navigator.mediaDevices;
    find("#browser-ears").hidden = !recogniserOf(window);
    if (this.on) {
      if (this.#sound) this.connection.send({ type: "microphone", on: true });
      return;
    }
    if (server && navigator.mediaDevices && this.#chosen() === "none" && !this.#offered)
      find("[name=ears][value=server]", HTMLInputElement).checked = true;
    this.#offered = true;
    this.#choose();
  }

  #chosen() {
    return find("[name=ears]:checked", HTMLInputElement).value;
  }

  #choose() {
    this.stop();
    this.#button.hidden = this.#chosen() === "none";
  }

  async start() {
    if (this.on) return;
    const wanted = {};
    this.#wanted = wanted;
    this.#button.setAttribute("aria-pressed", "true");
    try {
      if (this.#chosen() === "server") await this.#stream(wanted);
      else this.#listen(wanted);
    } catch (error) {
      if (this.#wanted === wanted) this.#fail(error instanceof Error ? error.message : String(error));
    }
  }

  stop() {
    if (!this.on) return;
    this.#wanted = null;
    this.#button.setAttribute("aria-pressed", "false");
    this.#recogniser?.stop();
    if (!this.#sound) return;
    silence(this.#sound);
    this.#sound = null;
    this.connection.send({ type: "microphone", on: false });
  }

  /** @param {string} reason */
  #fail(reason) {
    this.stop();
    this.onFail(reason);
  }

  /** Sound to the server: 16 kHz, 16 bit, mono. @param {object} wanted */
  async #stream(wanted) {
    const stream = await navigator.mediaDevices.getUserMedia({
      audio: { channelCount: 1, echoCancellation: true, noiseSuppression: true },
    });
    const sound = { stream, context: new AudioContext() };
    try {
      await sound.context.audioWorklet.addModule("worklet.js");
    } catch (error) {
      silence(sound);
      throw error;
    }
    if (this.#wanted !== wanted) {
      // let go before it was open
      silence(sound);
      return;
    }
    const node = new AudioWorkletNode(sound.context, "pcm", { numberOfOutputs: 0 });
    node.port.onmessage = ({ data }) => this.connection.send(data);
    sound.context.createMediaStreamSource(stream).connect(node);
    this.#sound = sound;
    this.connection.send({ type: "microphone", on: true });
  }

  /** @param {object} wanted */
  #listen(wanted) {
    const Recogniser = recogniserOf(window);
    if (!Recogniser) throw new TypeError("found no recogniser, expected the browser's");
    const recogniser = new Recogniser();
    this.#recogniser = recogniser;
    recogniser.lang = "en-US";
    recogniser.continuous = true;
    recogniser.onresult = ({ results, resultIndex }) => this.onHeard(results[resultIndex][0].transcript);
    recogniser.onerror = ({ error }) => {
      if (this.#wanted === wanted) this.#fail(error);
    };
    recogniser.onend = () => {
      if (this.#wanted === wanted) this.stop();
    };
    recogniser.start();
  }
}

/** @param {Window} browser */
const recogniserOf = (browser) => browser.SpeechRecognition ?? browser.webkitSpeechRecognition;

/** @param {Sound} sound */
function silence({ stream, context }) {
  for (const track of stream.getTracks()) track.stop();
  context.close();
}
