// The page: what the server tells is shown, what the person says and shows is sent.

import { Arm } from "./arm-pointing.js";
import { Connection } from "./connection.js";
import { Editor } from "./editor.js";
import { vector } from "./geometry.js";
import { Labels } from "./labels.js";
import { Mind } from "./panels.js";
import { Speech } from "./microphone.js";
import { Stage } from "./table-view.js";
import { Study } from "./study.js";
import { chosenLanguage, english, isEnglish, setLanguage, text } from "./texts.js";

const $ = (selector) => document.querySelector(selector);
const ARM = 0.6; // m, from the head to the wrist of an arm that points
const REPEAT = 80; // ms between rays while the person points
const SHOWN = 1200; // ms that pointing by the keyboard lasts

let scene = null, insight = true, latest = null, target = null, pointing = null, held = false, begun = null, bubbleTimer = null, state = "connecting";
let own = null; // the TOML of the last table that was not built in

setLanguage(chosenLanguage());
$("#language").value = chosenLanguage();
const connection = new Connection(told, changed);
const stage = makeStage();
const labels = new Labels($("#items"), (id) => pointAt(id));
const mind = new Mind();
const speech = new Speech(connection, (words) => say(words), (error) => show(text("no_microphone", { reason: error })));
const editor = new Editor(stage, labels, (toml) => begin({ toml }));
const arm = new Arm(stage, (place) => { if (!held && !editor.open) pointTo(place); }, () => { if (!held) endPointing(); }, () => begin(table()));

const study = new Study({ connection, stage, labels, announce, bubble, show, quiet: () => { speech.stop(); if (pointing !== null) endPointing(); }, choose: (language) => choose(language) });

function makeStage() {
  try {
    return new Stage($("#view"), follow);
  } catch {
    $("#stage").classList.add("flat");
    $("#hint").textContent = text("no_3d");
    return null;
  }
}

function begin(table) {
  own = table.toml ?? own;
  $("#scene").value = typeof table === "string" ? table : "own";
  if (JSON.stringify(table) !== begun) arm.forget();
  connection.begin({ scene: table, sigma: arm.sigma, planner: $("#planner").value, seed: Math.floor(Math.random() * 2 ** 31) });
}

// What the server tells.

function changed(now) {
  state = now;
  $("#state").textContent = text(now);
}

function show(line) {
  $("#state").textContent = line;
}

function told(message) {
  ({ welcome, belief, decided, observed: happened, action: acted, say: spoken, status, ended, error })[message.type]?.(message);
  study.told(message);
}

function welcome(message) {
  scene = message.scene;
  insight = message.insight;
  $("#thinking").hidden = !insight;
  applyThinking();
  $("#scene").value = message.scene_name ?? "own";
  $("#scene [value=own]").hidden = message.scene_name !== null && own === null;
  $("#planner").value = message.planner;
  $("#end").hidden = true;
  $("#answers").hidden = true;
  speech.offer(message.ears);
  labels.set(scene, insight);
  labels.hide(null);
  mind.set(scene);
  stage?.set(scene);
  editor.load(scene);
  begun = JSON.stringify(table());
  message.past.forEach((event) => mind.tell(event));
  if (message.belief) believe(message.belief, false);
  if (message.picked) ended(message);
  else if (message.resumed) show(text("resumed"));
  else if (!study.on) bubble("greeting", 6000);
}

function believe(shares, provisional) {
  latest = shares;
  labels.believe(shares, provisional);
  if (!provisional) mind.believe(shares);
}

function belief(message) {
  if (!message.belief) return;
  believe(message.belief, message.provisional);
  if (!message.provisional) mind.conclude(message.belief, message.even);
}

function decided(message) {
  mind.decide(message);
  if (message.action !== "wait" || $("#answers").hidden) labels.about(message.item ?? null); // a question stays marked
  if (message.action === "point") stage?.ask(message.item);
  if (message.action === "pick") stage?.fetch(message.item);
  if (message.action !== "wait") $("#answers").hidden = true;
}

function happened(message) {
  mind.tell(message);
  if (!message.observation.utterance) return;
  if (!message.understood) bubble("not_understood", 4000);
  else if (!$("#answers").hidden) $("#bubble").hidden = true;
  $("#answers").hidden = true;
  stage?.rest();
}

function acted(message) {
  mind.tell(message);
  if (message.outcome !== "done") stage?.rest();
}

function spoken(message) {
  bubble(message.key, message.key === "asks" ? null : 3500, message.text);
  if (message.key === "asks") $("#answers").hidden = false; // an answer given before is none to this question
  speech.say(message);
}

function status(message) {
  if (message.sensor === "planner") show(text(message.state === "ok" ? "ready" : "preparing"));
  else if (message.sensor === "model" || message.sensor === "robot") show(message.state === "ok" ? text("ready") : text(`sensor_${message.sensor}`));
  else show(text(`sensor_${message.sensor}`, { state: text(`state_${message.state}`) }));
}

function ended({ picked }) {
  $("#outcome").textContent = text("got", { item: picked });
  $("#end").hidden = false;
  $("#answers").hidden = true;
  labels.about(picked);
  announce(text("got", { item: picked }));
}

function error({ code, message }) {
  if (!editor.refused(message)) show(text(code === "broken" && study.on ? "broken" : "refused", { message }));
}

// What the robot says: as a bubble, and to screen readers.

// duration: ms, null until something else is said or the question is answered.
function bubble(key, duration, plain = null) {
  const line = key ? english(key) : plain;
  const element = $("#bubble");
  element.replaceChildren(line);
  element.lang = "en";
  if (key && !isEnglish()) {
    const translated = document.createElement("small");
    translated.textContent = text(key);
    element.append(translated);
  }
  element.hidden = false;
  announce(line);
  clearTimeout(bubbleTimer);
  if (duration !== null) bubbleTimer = setTimeout(() => { element.hidden = true; }, duration);
  stage?.draw();
}

function announce(line) {
  $("#spoken").textContent = line;
}

function follow() {
  if (!scene) return;
  labels.follow(stage);
  arm.follow();
  const { x, y } = stage.seen(stage.mouth());
  const half = $("#bubble").offsetWidth / 2 + 8, width = $("#stage").clientWidth;
  $("#bubble").style.transform = `translate(${Math.min(Math.max(x, half), width - half).toFixed(1)}px, ${Math.max(y, 76).toFixed(1)}px)`;
}

// What the person says.

function say(words) {
  const line = words.trim();
  if (line) connection.send({ type: "typed", text: line });
}

$("#talk").addEventListener("submit", (event) => {
  event.preventDefault();
  say($("#say").value);
  $("#say").value = "";
});
$("#say").addEventListener("input", () => connection.send({ type: "typing", text: $("#say").value }));
for (const button of document.querySelectorAll("[data-say]")) button.addEventListener("click", () => { say(button.dataset.say); $("#answers").hidden = true; $("#say").focus(); });
$("#stop").addEventListener("click", () => say("stop"));

// Where the person points: with the mouse or a finger held down, or with an item's button.

function send() {
  const head = vector(scene.head), way = target.clone().sub(head).setLength(ARM);
  connection.send({ type: "ray", head: scene.head, wrist: head.add(way).toArray() });
}

function pointTo(place) {
  if (!place) return;
  target = place;
  stage?.point(target);
  if (pointing === null) {
    pointing = setInterval(send, REPEAT);
    send();
  }
}

function endPointing() {
  clearInterval(pointing);
  pointing = null;
  stage?.point(null);
}

function pointAt(id) {
  if (editor.open) return;
  const item = scene.items.find((each) => each.id === id);
  pointTo(vector(item.position));
  setTimeout(endPointing, SHOWN);
}

const view = $("#view");
const placeOf = (event) => stage.at(event.offsetX, event.offsetY);
view.addEventListener("pointerdown", (event) => {
  if (!scene || event.button) return;
  view.setPointerCapture(event.pointerId);
  held = true;
  if (editor.open) editor.grab(placeOf(event));
  else pointTo(placeOf(event));
});
view.addEventListener("pointermove", (event) => {
  if (editor.held) editor.drag(placeOf(event));
  else if (pointing !== null && event.buttons) pointTo(placeOf(event));
});
for (const kind of ["pointerup", "pointercancel"]) view.addEventListener(kind, () => { held = false; editor.drop(); if (pointing !== null) endPointing(); });

// The menu.

function applyThinking() {
  document.body.classList.toggle("plain", !insight || $("#thinking").getAttribute("aria-pressed") !== "true");
}

function disclose(button, panel) {
  $(button).addEventListener("click", () => {
    const open = $(panel).hidden;
    for (const [each, other] of [["#options", "#settings"], ["#edit", "#editor"]]) {
      $(other).hidden = !(open && other === panel);
      $(each).setAttribute("aria-expanded", String(open && other === panel));
    }
    editor.shown(!$("#editor").hidden);
  });
}

$("#thinking").addEventListener("click", () => {
  const pressed = $("#thinking").getAttribute("aria-pressed") === "true";
  $("#thinking").setAttribute("aria-pressed", String(!pressed));
  applyThinking();
});
disclose("#options", "#settings");
disclose("#edit", "#editor");
document.addEventListener("keydown", (event) => {
  if (event.key !== "Escape") return;
  for (const [button, panel] of [["#options", "#settings"], ["#edit", "#editor"]]) if (!$(panel).hidden) { $(button).click(); $(button).focus(); }
});
function choose(language) {
  $("#language").value = language;
  setLanguage(language);
  changed(state);
  arm.speak();
  if (scene) { labels.set(scene, insight); if (latest) believe(latest, false); editor.load(scene); stage?.draw(); }
  if (mind.decided) mind.decide(mind.decided);
  study.again();
}
$("#language").addEventListener("change", () => choose($("#language").value));
const table = () => ($("#scene").value === "own" ? { toml: own ?? editor.toml() } : $("#scene").value);
$("#scene").addEventListener("change", () => begin(table()));
$("#planner").addEventListener("change", () => begin(table()));
$("#again").addEventListener("click", () => { begin(table()); $("#say").focus(); });

if (connection.resume) connection.begin(null);
else begin((await (await fetch("table.json")).json()).scene);
