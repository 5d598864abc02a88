// The voices: the person's, through the microphone, and the robot's.

const $ = (selector) => document.querySelector(selector);
const Recogniser = window.SpeechRecognition ?? window.webkitSpeechRecognition;

export class Speech {
  #wanted = null; // while the microphone is to be open; another each time, so that what opens late knows that it is not

  constructor(connection, heard, failed) {
    this.connection = connection;
    this.heard = heard; // called with words that the browser recognised
    this.failed = failed; // called with why the microphone cannot be used
    const button = $("#microphone");
    button.addEventListener("pointerdown", () => { if ($("#hold").checked) this.start(); });
    for (const kind of ["pointerup", "pointerleave"]) button.addEventListener(kind, () => { if ($("#hold").checked) this.stop(); });
    button.addEventListener("keydown", (event) => { if ($("#hold").checked && event.key === " " && !event.repeat) this.start(); });
    button.addEventListener("keyup", (event) => { if ($("#hold").checked && event.key === " ") this.stop(); });
    button.addEventListener("click", () => { if (!$("#hold").checked) this[this.on ? "stop" : "start"](); });
    for (const choice of document.querySelectorAll("[name=ears]")) choice.addEventListener("change", () => this.#choose());
  }

  get on() { return this.#wanted !== null; }

  // Offer the ways of recognising speech that there are here; an open microphone stays open over a new interaction.
  offer(server) {
    $("#server-ears").hidden = !server || !navigator.mediaDevices;
    $("#browser-ears").hidden = !Recogniser;
    if (this.on) {
      if (this.sound) this.connection.send({ type: "microphone", on: true });
      return;
    }
    if (server && navigator.mediaDevices && this.#chosen() === "none" && !this.offered) $("[name=ears][value=server]").checked = true;
    this.offered = true;
    this.#choose();
  }

  #chosen() { return $("[name=ears]:checked").value; }

  #choose() {
    this.stop();
    $("#microphone").hidden = this.#chosen() === "none";
  }

  async start() {
    if (this.on) return;
    const wanted = {};
    this.#wanted = wanted;
    $("#microphone").setAttribute("aria-pressed", "true");
    try {
      if (this.#chosen() === "server") await this.#stream(wanted);
      else this.#listen(wanted);
    } catch (error) {
      if (this.#wanted === wanted) this.#fail(error.message);
    }
  }

  stop() {
    if (!this.on) return;
    this.#wanted = null;
    $("#microphone").setAttribute("aria-pressed", "false");
    this.recogniser?.stop();
    if (!this.sound) return;
    silence(this.sound);
    this.sound = null;
    this.connection.send({ type: "microphone", on: false });
  }

  #fail(reason) {
    this.stop();
    this.failed(reason);
  }

  // Sound to the server: 16 kHz, 16 bit, mono.
  async #stream(wanted) {
    const stream = await navigator.mediaDevices.getUserMedia({ audio: { channelCount: 1, echoCancellation: true, noiseSuppression: true } });
    const sound = { stream, context: new AudioContext() };
    try {
      await sound.context.audioWorklet.addModule("worklet.js");
      if (this.#wanted !== wanted) return silence(sound); // let go before it was open
    } catch (error) {
      silence(sound);
      throw error;
    }
    const node = new AudioWorkletNode(sound.context, "pcm", { numberOfOutputs: 0 });
    node.port.onmessage = ({ data }) => this.connection.send(data);
    sound.context.createMediaStreamSource(stream).connect(node);
    this.sound = sound;
    this.connection.send({ type: "microphone", on: true });
  }

  #listen(wanted) {
    const recogniser = new Recogniser();
    this.recogniser = recogniser;
    recogniser.lang = "en-US";
    recogniser.continuous = true;
    recogniser.onresult = ({ results, resultIndex }) => this.heard(results[resultIndex][0].transcript);
    recogniser.onerror = ({ error }) => { if (this.#wanted === wanted) this.#fail(error); };
    recogniser.onend = () => { if (this.#wanted === wanted) this.stop(); };
    recogniser.start();
  }

  // The robot speaks: the server's sound if there is one, else the browser's voice.
  say({ text, audio }) {
    if (!$("#voice").checked) return;
    if (audio) new Audio(audio).play().catch(() => {}); // before the first click a browser may forbid sound
    else if (window.speechSynthesis) {
      const spoken = new SpeechSynthesisUtterance(text);
      spoken.lang = "en";
      speechSynthesis.cancel();
      speechSynthesis.speak(spoken);
    }
  }
}

function silence({ stream, context }) {
  for (const track of stream.getTracks()) track.stop();
  context.close();
}
