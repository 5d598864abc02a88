// The line to the server. It comes back by itself, and goes on where it was.

const TAKEN_OVER = 4001;
const REFUSED = 1008;
const TRY_LATER = 1013;
const SLOWEST = 5000; // ms between attempts
const STEADY = 10000; // ms after which a line counts as good

export class Connection {
  #socket = null;
  #attempts = 0;
  #steady = null;
  #hello = null;
  #wish = null;

  constructor(told, changed) {
    this.told = told; // called with each message
    this.changed = changed; // called with "connecting", "lost", "busy" or "moved"
    this.token = new URLSearchParams(location.hash.slice(1)).get("token");
  }

  get resume() { return sessionStorage.getItem("resume"); }

  get participant() { return localStorage.getItem("participant"); } // of a study: who closes the page may come back later

  // Know nothing more of the participant.
  forget() { localStorage.removeItem("participant"); }

  // Begin an interaction; without a scene, go on with the last one.
  begin(hello) {
    if (hello) sessionStorage.removeItem("resume");
    this.#hello = hello ?? this.#hello ?? {};
    this.#attempts = 0;
    this.#connect();
  }

  send(message) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(message instanceof ArrayBuffer ? message : JSON.stringify(message));
  }

  // Withdraw from a study; if the line is lost meanwhile, as soon as it is back.
  withdraw() {
    this.#wish = { type: "withdraw" };
    this.send(this.#wish);
  }

  #connect() {
    if (this.#socket) {
      this.#socket.onclose = null;
      this.#socket.close();
    }
    this.changed(this.#attempts ? "lost" : "connecting");
    const address = new URL("session", location.href);
    address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    address.hash = "";
    const socket = new WebSocket(address);
    this.#socket = socket;
    socket.onopen = () => this.send({ type: "hello", version: 1, ...this.#hello, resume: this.resume, participant: this.participant, token: this.token });
    socket.onmessage = ({ data }) => this.#received(JSON.parse(data));
    socket.onclose = ({ code }) => this.#lost(code);
  }

  #received(message) {
    this.#steady ??= setTimeout(() => { this.#attempts = 0; }, STEADY);
    if (message.resume) (message.type === "stage" ? localStorage : sessionStorage).setItem(message.type === "stage" ? "participant" : "resume", message.resume);
    if (message.stage === "withdrawn") this.#wish = null;
    else if (message.type === "stage" && this.#wish) this.send(this.#wish);
    this.told(message);
  }

  #lost(code) {
    if (code === TAKEN_OVER) this.changed("moved");
    if (code === TAKEN_OVER || code === REFUSED) return;
    clearTimeout(this.#steady);
    this.#steady = null;
    this.#attempts += 1;
    this.changed(code === TRY_LATER ? "busy" : "lost");
    setTimeout(() => this.#connect(), Math.min(250 * 2 ** this.#attempts, SLOWEST));
  }
}
