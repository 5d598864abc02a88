// What the server tells of an interaction, shown: on the table, at the items, in the panels and in words.

import { find } from "./dom.js";
import { isQuestion } from "./robot-voice.js";
import { text } from "./texts.js";

/** @import { Acted, Belief, BeliefMessage, Decided, Ended, ErrorMessage, Observed } from "./messages.js" */
/** @import { Say, Scene, ServerMessage, Status, Welcome } from "./messages.js" */
/** @import { Editor } from "./editor.js" */
/** @import { Examples } from "./examples.js" */
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
 * @property {Examples} examples
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
  /** @type {string | null} */
  #asked = null; // the item of a question that waits for its answer
  /** @type {string | null} */
  #picked = null; // what the person was handed over, and has not given back
  /** @type {string | null} */
  #about = null; // the item that the last action is about

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
      case "heard":
        return this.#answer(message.asked);
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
    if (this.#picked) find("#outcome").textContent = text("got", { item: this.#picked });
  }

  /** @param {Welcome} message */
  #begin(message) {
    const { view, labels, panel, log, voice, editor, examples, onWelcome, inStudy } = this.parts,
      { scene, insight } = message;
    this.scene = scene;
    this.insight = insight;
    this.#give(null);
    this.#settle();
    labels.set(scene, insight);
    panel.set(scene);
    log.clear();
    view?.set(scene);
    editor.load(scene);
    onWelcome(message);
    message.past.forEach((event) => log.add(event));
    if (message.belief) this.#believe(message.belief, false);
    examples.set(message.examples ?? [], !message.begun);
    if (message.resumed && message.picked === null) this.parts.showState(text("resumed"));
    if (message.picked !== null) {
      view?.robot.fetch(message.picked);
      labels.about(message.picked);
      this.#give(message.picked);
    } else if (message.asked) this.#resumeQuestion(message.asked);
    else if (!message.resumed && !inStudy()) voice.show("greeting", 6000);
  }

  /** Ask again as it was asked before the page was reloaded. @param {string} item */
  #resumeQuestion(item) {
    const { view, labels, voice } = this.parts;
    view?.robot.ask(item);
    labels.about(item);
    voice.show("asks", null);
    this.#await(item);
  }

  /** Let the person answer a question. @param {string} item */
  #await(item) {
    this.#asked = item;
    find("#answers").hidden = false;
  }

  /** No question waits for an answer any more. */
  #settle() {
    this.#asked = null;
    find("#answers").hidden = true;
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
    if (action === "wait" && this.#asked) return; // a question stays as it is
    labels.about(item ?? null);
    if (action === "point" && item) view?.robot.ask(item);
    if (action === "pick" && item) view?.robot.fetch(item);
    if (item !== this.#asked) this.#settle();
    this.#about = item ?? null;
  }

  /** @param {Observed} message */
  #observe(message) {
    this.parts.log.add(message);
    if (message.anew) {
      this.#give(null);
      this.parts.labels.about(null);
    }
    this.parts.examples.show(!message.begun);
    if (!message.early && (message.anew || message.observation.utterance)) this.#answer(message.asked ?? null);
  }

  /** Something was said: the robot rests its arm, unless its question still waits. @param {string | null} asked */
  #answer(asked) {
    if (asked) return;
    if (this.#asked) this.parts.voice.hide();
    this.#settle();
    this.parts.view?.robot.rest();
  }

  /** @param {Acted} message */
  #act(message) {
    const { outcome, action, item } = message;
    this.parts.log.add(message);
    if (outcome !== "done") this.parts.view?.robot.rest();
    if (outcome === "returned") this.#give(null);
    if (action !== "pick" || outcome !== "done") return;
    this.#give(item);
    this.parts.examples.show(true);
  }

  /** @param {Say} message */
  #say(message) {
    this.parts.voice.say(message);
    if (isQuestion(message) && this.#about) this.#await(this.#about); // an answer given before is none to this question
    if (message.key === "objected") this.parts.view?.robot.putBack();
  }

  /** The round of a study is over. @param {Ended} message */
  #end({ picked }) {
    this.#settle();
    this.parts.labels.about(picked);
  }

  /** The person has an item; null: they have none any more. @param {string | null} item */
  #give(item) {
    this.#picked = item;
    find("#end").hidden = item === null;
    if (item === null) return;
    const line = text("got", { item });
    find("#outcome").textContent = line;
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
