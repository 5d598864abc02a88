import assert from "node:assert/strict";
import { afterEach, beforeEach, mock, test } from "node:test";
import { open } from "./browser.js";
import { Connection } from "#page/connection.js";

/** @import { ServerMessage } from "#page/messages.js" */

/** A WebSocket that does what a test says. */
class FakeWebSocket {
  static OPEN = 1;
  /** @type {FakeWebSocket[]} */
  static made = [];
  readyState = 0;
  /** @type {(() => void) | null} */
  onopen = null;
  /** @type {((event: { data: string }) => void) | null} */
  onmessage = null;
  /** @type {((event: { code: number }) => void) | null} */
  onclose = null;
  /** @type {any[]} */
  sent = [];
  closed = false;

  /** @param {URL} address */
  constructor(address) {
    this.address = String(address);
    FakeWebSocket.made.push(this);
  }

  static get last() {
    return FakeWebSocket.made[FakeWebSocket.made.length - 1];
  }

  /** @param {string | ArrayBuffer} data */
  send(data) {
    this.sent.push(typeof data === "string" ? JSON.parse(data) : data);
  }

  close() {
    this.closed = true;
  }

  accept() {
    this.readyState = 1;
    this.onopen?.();
  }

  /** @param {object} message */
  tell(message) {
    this.onmessage?.({ data: JSON.stringify(message) });
  }

  /** @param {number} code */
  drop(code = 1006) {
    this.readyState = 3;
    this.onclose?.({ code });
  }
}

function connected() {
  /** @type {ServerMessage[]} */
  const messages = [];
  /** @type {string[]} */
  const states = [];
  const connection = new Connection(
    (message) => messages.push(message),
    (state) => states.push(state),
  );
  connection.begin({ scene: "ambiguous", seed: 7 });
  FakeWebSocket.last.accept();
  return { connection, messages, states };
}

beforeEach(() => {
  open("http://robot.test/#token=secret");
  FakeWebSocket.made = [];
  Object.assign(globalThis, { WebSocket: FakeWebSocket });
  mock.timers.enable({ apis: ["setTimeout"] });
});
afterEach(() => mock.timers.reset());

test("the first message is a hello, with what is asked for and the token of the address", () => {
  const { states } = connected();
  assert.equal(FakeWebSocket.last.address, "ws://robot.test/session");
  assert.deepEqual(FakeWebSocket.last.sent, [
    { type: "hello", version: 1, scene: "ambiguous", seed: 7, resume: null, participant: null, token: "secret" },
  ]);
  assert.deepEqual(states, ["connecting"]);
});

test("a page over TLS talks over TLS", () => {
  open("https://robot.test/");
  connected();
  assert.equal(FakeWebSocket.last.address, "wss://robot.test/session");
});

test("a lost connection comes back by itself, and asks to go on", () => {
  const { states } = connected();
  FakeWebSocket.last.tell({ type: "welcome", resume: "abc" });
  FakeWebSocket.last.drop();
  assert.deepEqual(states, ["connecting", "lost"]);
  mock.timers.tick(499);
  assert.equal(FakeWebSocket.made.length, 1);
  mock.timers.tick(1);
  FakeWebSocket.last.accept();
  assert.equal(FakeWebSocket.made.length, 2);
  assert.equal(FakeWebSocket.last.sent[0].resume, "abc");
});

test("attempts come ever more rarely, up to five seconds, until a connection holds", () => {
  connected();
  FakeWebSocket.last.drop();
  for (const pause of [500, 1000, 2000, 4000, 5000, 5000]) {
    const before = FakeWebSocket.made.length;
    mock.timers.tick(pause - 1);
    assert.equal(FakeWebSocket.made.length, before);
    mock.timers.tick(1);
    assert.equal(FakeWebSocket.made.length, before + 1);
    if (before < 6) FakeWebSocket.last.drop();
  }
  FakeWebSocket.last.accept();
  FakeWebSocket.last.tell({ type: "welcome" });
  mock.timers.tick(10_000); // it holds
  FakeWebSocket.last.drop();
  mock.timers.tick(500);
  assert.equal(FakeWebSocket.made.length, 8);
});

test("one that breaks again soon does not count as good", () => {
  connected();
  FakeWebSocket.last.drop();
  mock.timers.tick(500);
  FakeWebSocket.last.tell({ type: "welcome" });
  mock.timers.tick(9_999);
  FakeWebSocket.last.drop();
  mock.timers.tick(999);
  assert.equal(FakeWebSocket.made.length, 2);
  mock.timers.tick(1);
  assert.equal(FakeWebSocket.made.length, 3);
});

test("a server without room is tried again, and said to have none", () => {
  const { states } = connected();
  FakeWebSocket.last.drop(1013);
  assert.equal(states.at(-1), "busy");
  mock.timers.tick(500);
  assert.equal(FakeWebSocket.made.length, 2);
});

test("a conversation that goes on in another window, or was refused, is left alone", () => {
  const { states } = connected();
  FakeWebSocket.last.drop(4001);
  assert.equal(states.at(-1), "moved");
  connected();
  FakeWebSocket.last.drop(1008);
  mock.timers.tick(60_000);
  assert.equal(FakeWebSocket.made.length, 2);
});

test("a new interaction closes the connection before, whose end changes nothing, and forgets where it was", () => {
  const { connection, states } = connected();
  FakeWebSocket.last.tell({ type: "welcome", resume: "abc" });
  connection.begin({ scene: "unambiguous" });
  const [before, now] = FakeWebSocket.made;
  before.drop();
  now.accept();
  assert.ok(before.closed);
  assert.deepEqual(states, ["connecting", "connecting"]);
  assert.equal(now.sent[0].resume, null);
  assert.equal(now.sent[0].scene, "unambiguous");
});

test("nothing is sent while there is no connection, and sound is sent as it is", () => {
  const { connection } = connected();
  const sound = new ArrayBuffer(4);
  connection.send(sound);
  FakeWebSocket.last.readyState = 3;
  connection.send({ type: "typed", text: "lost" });
  assert.deepEqual(FakeWebSocket.last.sent.slice(1), [sound]);
});

test("a participant is known again by another page, until forgotten", () => {
  const { connection } = connected();
  FakeWebSocket.last.tell({ type: "stage", stage: "practice", resume: "somebody" });
  assert.deepEqual([connection.participant, connection.resume], ["somebody", null]);
  connection.forget();
  assert.equal(connection.participant, null);
});

test("who withdraws while the connection is lost is withdrawn when it is back, once", () => {
  const { connection } = connected();
  FakeWebSocket.last.drop();
  connection.withdraw();
  mock.timers.tick(500);
  FakeWebSocket.last.accept();
  FakeWebSocket.last.tell({ type: "stage", stage: "trials" });
  FakeWebSocket.last.tell({ type: "stage", stage: "withdrawn" });
  FakeWebSocket.last.tell({ type: "stage", stage: "consent" });
  assert.deepEqual(FakeWebSocket.last.sent.slice(1), [{ type: "withdraw" }]);
});
