// The page: its parts, and what goes from one to another.

import { ArmPointing } from "./arm-pointing.js";
import { Connection } from "./connection.js";
import { find, findAll } from "./dom.js";
import { Editor } from "./editor.js";
import { Examples } from "./examples.js";
import { Interaction } from "./interaction.js";
import { Labels } from "./labels.js";
import { Menu } from "./menu.js";
import { Microphone } from "./microphone.js";
import { DecisionPanel, EventLog } from "./panels.js";
import { Pointing } from "./pointing.js";
import { RobotVoice } from "./robot-voice.js";
import { Study } from "./study.js";
import { TableView } from "./table-view.js";
import { preferredLanguage, setLanguage, text } from "./texts.js";

/** @import { ConnectionState } from "./connection.js" */
/** @import { SceneChoice, ServerMessage, Welcome } from "./messages.js" */

class App {
  /** @type {string | null} */
  #begun = null; // the table of the interaction, as JSON
  /** @type {ConnectionState} */
  #state = "connecting";
  #held = false; // the mouse button or a finger on the table
  #connection = new Connection(
    (message) => this.#receive(message),
    (state) => this.#change(state),
  );
  #view = viewOf(find("#view", HTMLCanvasElement), () => this.#follow());
  #labels = new Labels(find("#items"), (id) => {
    if (!this.#editor.open) this.#pointing.atItem(id);
  });
  #voice = new RobotVoice(this.#view);
  #microphone = new Microphone(
    this.#connection,
    (words) => this.#say(words),
    (reason) => showState(text("no_microphone", { reason })),
  );
  #editor = new Editor(this.#view, (toml) => this.#begin({ toml }));
  #pointing = new Pointing(this.#connection, (target) => this.#view?.point(target));
  #arm = new ArmPointing(this.#view, {
    onPoint: (place) => {
      if (!this.#held && !this.#editor.open) this.#pointing.at(place);
    },
    onRelease: () => {
      if (!this.#held) this.#pointing.end();
    },
    onCalibrate: () => this.#begin(this.#menu.table),
  });
  #menu = new Menu({
    onLanguage: (language) => this.#choose(language),
    onBegin: () => this.#begin(this.#menu.table),
    onEdit: (open) => this.#editor.show(open),
    editedTable: () => this.#editor.toml(),
  });
  /** @type {Study} */
  #study = new Study({
    connection: this.#connection,
    view: this.#view,
    labels: this.#labels,
    voice: this.#voice,
    showState,
    quiet: () => {
      this.#microphone.stop();
      this.#pointing.end();
    },
    choose: (language) => this.#choose(language),
  });
  #examples = new Examples(find("#examples"), (words) => this.#say(words));
  #interaction = new Interaction({
    view: this.#view,
    labels: this.#labels,
    panel: new DecisionPanel(),
    log: new EventLog(),
    voice: this.#voice,
    editor: this.#editor,
    examples: this.#examples,
    showState,
    onWelcome: (message) => this.#welcome(message),
    inStudy: () => this.#study.on,
  });

  constructor() {
    this.#menu.language = preferredLanguage();
    this.#listenToTyping();
    this.#listenToPointer(find("#view"));
  }

  async start() {
    if (this.#connection.resume) this.#connection.begin(null);
    else this.#begin((await (await fetch("table.json")).json()).scene);
  }

  /** @param {SceneChoice} table */
  #begin(table) {
    this.#menu.choose(table);
    if (JSON.stringify(table) !== this.#begun) this.#arm.forget();
    this.#connection.begin({
      scene: table,
      sigma: this.#arm.sigma,
      planner: this.#menu.planner,
      seed: Math.floor(Math.random() * 2 ** 31),
    });
  }

  /** @param {ServerMessage} message */
  #receive(message) {
    this.#interaction.receive(message);
    this.#study.receive(message);
  }

  /** @param {Welcome} message */
  #welcome(message) {
    this.#menu.welcome(message);
    this.#microphone.offer(message.ears);
    this.#pointing.scene = message.scene;
    this.#begun = JSON.stringify(this.#menu.table);
  }

  /** @param {ConnectionState} state */
  #change(state) {
    this.#state = state;
    showState(text(state));
  }

  /** @param {string} language */
  #choose(language) {
    this.#menu.language = language;
    setLanguage(language);
    showState(text(this.#state));
    this.#arm.translate();
    this.#interaction.translate();
    this.#examples.translate();
    this.#study.translate();
  }

  #follow() {
    if (!this.#view || !this.#interaction.scene) return;
    this.#labels.follow(this.#view);
    this.#arm.follow();
    this.#voice.follow(this.#view);
  }

  /** @param {string} words */
  #say(words) {
    const line = words.trim();
    if (line) this.#connection.send({ type: "typed", text: line });
  }

  #listenToTyping() {
    const input = find("#say", HTMLInputElement);
    find("#talk").addEventListener("submit", (event) => {
      event.preventDefault();
      this.#say(input.value);
      input.value = "";
    });
    input.addEventListener("input", () => this.#connection.send({ type: "typing", text: input.value }));
    for (const answer of findAll("[data-say]", HTMLElement))
      answer.addEventListener("click", () => {
        this.#say(answer.dataset.say ?? "");
        input.focus();
      });
    find("#stop").addEventListener("click", () => this.#say("stop"));
  }

  /** Pointing, or dragging an item while the table is edited. @param {HTMLElement} canvas */
  #listenToPointer(canvas) {
    /** @param {PointerEvent} event */
    const place = (event) => this.#view?.at(event.offsetX, event.offsetY) ?? null;
    canvas.addEventListener("pointerdown", (event) => {
      if (!this.#interaction.scene || event.button) return;
      canvas.setPointerCapture(event.pointerId);
      this.#held = true;
      if (this.#editor.open) this.#editor.grab(place(event));
      else this.#pointing.at(place(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      if (this.#editor.dragging) this.#editor.drag(place(event));
      else if (this.#pointing.on && event.buttons) this.#pointing.at(place(event));
    });
    for (const kind of ["pointerup", "pointercancel"])
      canvas.addEventListener(kind, () => {
        this.#held = false;
        this.#editor.drop();
        this.#pointing.end();
      });
  }
}

/**
 * The table in 3-D, or null where the browser has no WebGL.
 * @param {HTMLCanvasElement} canvas
 * @param {() => void} onDrawn
 */
function viewOf(canvas, onDrawn) {
  try {
    return new TableView(canvas, onDrawn);
  } catch {
    find("#view-area").classList.add("flat");
    find("#hint").textContent = text("no_3d");
    return null;
  }
}

/** @param {string} line */
function showState(line) {
  find("#state").textContent = line;
}

setLanguage(preferredLanguage());
await new App().start();
