// The voices: the person's, through the microphone, and the robot's.

const $ = (selector) => document.querySelector(selector);
const Recogniser = window.SpeechRecognition ?? window.webkitSpeechRecognition;

export class Speech {
  constructor(connection, heard, failed) {
    this.connection = connection;
    this.heard = heard; // called with words that the browser recognised
    this.failed = failed; // called with why the microphone cannot be used
    this.on = false;
    const button = $("#microphone");
    button.addEventListener("pointerdown", () => { if ($("#hold").checked) this.start(); });
    for (const kind of ["pointerup", "pointerleave"]) button.addEventListener(kind, () => { if ($("#hold").checked) this.stop(); });
    button.addEventListener("keydown", (event) => { if ($("#hold").checked && event.key === " " && !event.repeat) this.start(); });
    button.addEventListener("keyup", (event) => { if ($("#hold").checked && event.key === " ") this.stop(); });
    button.addEventListener("click", () => { if (!$("#hold").checked) this[this.on ? "stop" : "start"](); });
    for (const choice of document.querySelectorAll("[name=ears]")) choice.addEventListener("change", () => this.#choose());
  }


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
    this.on = true;
    $("#microphone").setAttribute("aria-pressed", "true");
    try {
      if (this.#chosen() === "server") await this.#stream();
      else this.#listen();
    } catch (error) {
      this.stop();
      this.failed(error.message);
    }
  }

  stop() {
    if (!this.on) return;
    this.on = false;
    $("#microphone").setAttribute("aria-pressed", "false");
    this.recogniser?.stop();
    if (this.sound) {
      for (const track of this.sound.stream.getTracks()) track.stop();
      this.sound.context.close();
      this.sound = null;
      this.connection.send({ type: "microphone", on: false });
    }
  }

  // Sound to the server: 16 kHz, 16 bit, mono.
  async #stream() {
    const stream = await navigator.mediaDevices.getUserMedia({ audio: { channelCount: 1, echoCancellation: true, noiseSuppression: true } });
    const context = new AudioContext();
    await context.audioWorklet.addModule("worklet.js");
    const node = new AudioWorkletNode(context, "pcm", { numberOfOutputs: 0 });
    node.port.onmessage = ({ data }) => this.connection.send(data);
    context.createMediaStreamSource(stream).connect(node);
    this.sound = { stream, context };
    this.connection.send({ type: "microphone", on: true });
    if (!this.on) { this.on = true; this.stop(); } // let go before the microphone was open
  }

  #listen() {
    this.recogniser = new Recogniser();
    this.recogniser.lang = "en-US";
    this.recogniser.continuous = true;
    this.recogniser.onresult = ({ results, resultIndex }) => this.heard(results[resultIndex][0].transcript);
    this.recogniser.onerror = ({ error }) => { this.stop(); this.failed(error); };
    this.recogniser.onend = () => this.stop();
    this.recogniser.start();
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
