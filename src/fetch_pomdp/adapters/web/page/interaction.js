// What the server tells of an interaction, shown: on the table, at the items, in the panels and in words.

import { find } from "./dom.js";
import { text } from "./texts.js";

/** @import { Acted, Belief, BeliefMessage, Decided, Ended, ErrorMessage, Observed } from "./messages.js" */
/** @import { Say, Scene, ServerMessage, Status, Welcome } from "./messages.js" */
/** @import { Editor } from "./editor.js" */
/** @import { Labels } from "./labels.js" */
/** @import { DecisionPanel, EventLog } from "./panels.js" */
/** @import { RobotVoice } from "./robot-voice.js" */
/** @import { TableView } from "./table-view.js" */
/**
 * @typedef {object} Parts where it is shown
 * @property {TableView | null} view
 * @property {Labels} labels
 * @property {DecisionPanel} panel
 * @property {EventLog} log
 * @property {RobotVoice} voice
 * @property {Editor} editor
 * @property {(line: string) => void} showState
 * @property {(message: Welcome) => void} onWelcome called when everything knows the table
 * @property {() => boolean} inStudy
 */

export class Interaction {
  /** @type {Scene | null} */
  scene = null;
  insight = false;
  /** @type {Belief | null} */
  #belief = null;

  /** @param {Parts} parts */
  constructor(parts) {
    this.parts = parts;
  }

  /** @param {ServerMessage} message */
  receive(message) {
    switch (message.type) {
      case "welcome":
        return this.#begin(message);
      case "belief":
        return this.#update(message);
      case "decided":
        return this.#decide(message);
      case "observed":
        return this.#observe(message);
      case "action":
        return this.#act(message);
      case "say":
        return this.#say(message);
      case "status":
        return this.parts.showState(statusLine(message));
      case "ended":
        return this.#end(message);
      case "error":
        return this.#complain(message);
    }
  }

  /** Say it again, in a language that was chosen meanwhile. */
  translate() {
    if (!this.scene) return;
    this.parts.labels.set(this.scene, this.insight);
    if (this.#belief) this.#believe(this.#belief, false);
    this.parts.editor.load(this.scene);
    this.parts.view?.draw();
    this.parts.panel.translate();
  }

  /** @param {Welcome} message */
  #begin(message) {
    const { view, labels, panel, log, voice, editor, onWelcome, inStudy } = this.parts,
      { scene, insight } = message;
    this.scene = scene;
    this.insight = insight;
    find("#end").hidden = true;
    find("#answers").hidden = true;
    labels.set(scene, insight);
    panel.set(scene);
    log.clear();
    view?.set(scene);
    editor.load(scene);
    onWelcome(message);
    message.past.forEach((event) => log.add(event));
    if (message.belief) this.#believe(message.belief, false);
    if (message.picked !== null) this.#end({ picked: message.picked });
    else if (message.resumed) this.parts.showState(text("resumed"));
    else if (!inStudy()) voice.show("greeting", 6000);
  }

  /** @param {Belief} belief @param {boolean} provisional */
  #believe(belief, provisional) {
    this.#belief = belief;
    this.parts.labels.believe(belief, provisional);
    if (!provisional) this.parts.panel.believe(belief);
  }

  /** @param {BeliefMessage} message */
  #update({ belief, provisional, even }) {
    if (!belief) return;
    this.#believe(belief, provisional);
    if (!provisional) this.parts.log.conclude(belief, even ?? false);
  }

  /** @param {Decided} message */
  #decide(message) {
    const { action, item } = message,
      { panel, labels, view } = this.parts;
    panel.decide(message);
    if (action !== "wait" || find("#answers").hidden) labels.about(item ?? null); // a question stays marked
    if (action === "point" && item) view?.robot.ask(item);
    if (action === "pick" && item) view?.robot.fetch(item);
    if (action !== "wait") find("#answers").hidden = true;
  }

  /** @param {Observed} message */
  #observe(message) {
    this.parts.log.add(message);
    if (!message.observation.utterance) return;
    if (!message.understood) this.parts.voice.show("not_understood", 4000);
    else if (!find("#answers").hidden) this.parts.voice.hide();
    find("#answers").hidden = true;
    this.parts.view?.robot.rest();
  }

  /** @param {Acted} message */
  #act(message) {
    this.parts.log.add(message);
    if (message.outcome !== "done") this.parts.view?.robot.rest();
  }

  /** @param {Say} message */
  #say(message) {
    this.parts.voice.say(message);
    if (message.key === "asks") find("#answers").hidden = false; // an answer given before is none to this question
  }

  /** @param {Pick<Ended, "picked">} message */
  #end({ picked }) {
    find("#answers").hidden = true;
    this.parts.labels.about(picked);
    if (picked === null) return;
    const line = text("got", { item: picked });
    find("#outcome").textContent = line;
    find("#end").hidden = false;
    this.parts.voice.announce(line);
  }

  /** @param {ErrorMessage} message */
  #complain({ code, message }) {
    if (!this.parts.editor.refused(message))
      this.parts.showState(text(code === "broken" && this.parts.inStudy() ? "broken" : "refused", { message }));
  }
}

/** @param {Status} message */
function statusLine({ sensor, state }) {
  if (sensor === "speech" || sensor === "skeleton") return text(`sensor_${sensor}`, { state: text(`state_${state}`) });
  if (state === "ok") return text("ready");
  return text(sensor === "planner" ? "preparing" : `sensor_${sensor}`);
}
