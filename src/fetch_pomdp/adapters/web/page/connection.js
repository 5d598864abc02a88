// The connection to the server. It comes back by itself, and goes on where it was.

/** @import { Hello, PageMessage, ServerMessage } from "./messages.js" */
/** @typedef {"connecting" | "lost" | "busy" | "moved"} ConnectionState */

const TAKEN_OVER = 4001;
const REFUSED = 1008;
const TRY_LATER = 1013;
const SLOWEST = 5000; // ms between attempts
const STEADY = 10000; // ms after which a connection counts as good

export class Connection {
  /** @type {WebSocket | null} */
  #socket = null;
  #attempts = 0;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #steady;
  /** @type {Hello} */
  #hello = {};
  #withdrawing = false;

  /**
   * @param {(message: ServerMessage) => void} onMessage
   * @param {(state: ConnectionState) => void} onChange
   */
  constructor(onMessage, onChange) {
    this.onMessage = onMessage;
    this.onChange = onChange;
    this.token = new URLSearchParams(location.hash.slice(1)).get("token");
  }

  get resume() {
    return sessionStorage.getItem("resume");
  }

  get participant() {
    return localStorage.getItem("participant");
  } // of a study: who closes the page may come back later

  /** Know nothing more of the participant. */
  forget() {
    localStorage.removeItem("participant");
  }

  /** Begin an interaction; without a hello, go on with the last one. @param {Hello | null} hello */
  begin(hello) {
    if (hello) sessionStorage.removeItem("resume");
    this.#hello = hello ?? this.#hello;
    this.#attempts = 0;
    this.#connect();
  }

  /** @param {PageMessage | ArrayBuffer} message */
  send(message) {
    if (this.#socket?.readyState === WebSocket.OPEN)
      this.#socket.send(message instanceof ArrayBuffer ? message : JSON.stringify(message));
  }

  /** Withdraw from a study; if the connection is lost meanwhile, as soon as it is back. */
  withdraw() {
    this.#withdrawing = true;
    this.send({ type: "withdraw" });
  }

  #connect() {
    if (this.#socket) {
      this.#socket.onclose = null;
      this.#socket.close();
    }
    this.onChange(this.#attempts ? "lost" : "connecting");
    const address = new URL("session", location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    address.hash = "";
    const socket = new WebSocket(address);
    this.#socket = socket;
    socket.onopen = () =>
      this.send({
        type: "hello",
        version: 1,
        ...this.#hello,
        resume: this.resume,
        participant: this.participant,
        token: this.token,
      });
    socket.onmessage = ({ data }) => this.#receive(JSON.parse(data));
    socket.onclose = ({ code }) => this.#lose(code);
  }

  /** @param {ServerMessage} message */
  #receive(message) {
    this.#steady ??= setTimeout(() => {
      this.#attempts = 0;
    }, STEADY);
    if (message.type === "welcome" && message.resume) sessionStorage.setItem("resume", message.resume);
    if (message.type === "stage") {
      if (message.resume) localStorage.setItem("participant", message.resume);
      if (message.stage === "withdrawn") this.#withdrawing = false;
      else if (this.#withdrawing) this.send({ type: "withdraw" });
    }
    this.onMessage(message);
  }

  /** @param {number} code of the WebSocket's close */
  #lose(code) {
    if (code === TAKEN_OVER) this.onChange("moved");
    if (code === TAKEN_OVER || code === REFUSED) return;
    clearTimeout(this.#steady);
    this.#steady = undefined;
    this.#attempts += 1;
    this.onChange(code === TRY_LATER ? "busy" : "lost");
    setTimeout(() => this.#connect(), Math.min(250 * 2 ** this.#attempts, SLOWEST));
  }
}
