// A study: from consent to completion code, and each trial from the ring around an item to what the robot brought.

import { find } from "./dom.js";
import { isQuestion } from "./robot-voice.js";
import { StudyPages } from "./study-pages.js";
import { inLanguage, text } from "./texts.js";
import { canWithdraw, isTrial, Trial } from "./trial.js";

/** @import { Connection } from "./connection.js" */
/** @import { Labels } from "./labels.js" */
/** @import { Begin, Countdown, Ended, ServerMessage, Stage, Welcome } from "./messages.js" */
/** @import { RobotVoice } from "./robot-voice.js" */
/** @import { TableView } from "./table-view.js" */
/**
 * @typedef {object} Page what a study shows itself with
 * @property {Connection} connection
 * @property {TableView | null} view
 * @property {Labels} labels
 * @property {RobotVoice} voice
 * @property {(line: string) => void} showState
 * @property {() => void} quiet called when the person neither speaks nor points any more
 * @property {(language: string) => void} choose
 */

export class Study {
  /** @type {Stage | null} */
  #stage = null;
  /** @type {Trial | null} */
  #trial = null;
  #ready = find("#ready", HTMLButtonElement);
  #next = find("#next", HTMLButtonElement);
  #giveUp = find("#give-up", HTMLButtonElement);

  /** @param {Page} page */
  constructor(page) {
    this.page = page;
    this.pages = new StudyPages(find("#study-page"), page.connection, page.choose);
    this.#ready.addEventListener("click", () => this.#send("ready", this.#ready));
    this.#next.addEventListener("click", () => this.#send("next", this.#next));
    this.#giveUp.addEventListener("click", () => this.#send("give_up", this.#giveUp));
    find("#withdraw").addEventListener("click", () => find("#leaving", HTMLDialogElement).showModal());
    find("#leave").addEventListener("click", () => page.connection.withdraw());
  }

  /** Whether this is a study: its first stage says so. */
  get on() {
    return this.#stage !== null;
  }

  /** Take in a message that the page has shown as any interaction's. @param {ServerMessage} message */
  receive(message) {
    if (message.type === "stage") this.#show(message);
    else if (message.type === "error")
      for (const button of [this.#ready, this.#next, this.#giveUp]) button.disabled = false;
    else if (this.#trial) this.#play(this.#trial, message);
  }

  /** Say it again, in a language that was chosen meanwhile. */
  translate() {
    if (!this.#stage) return;
    this.pages.translate();
    this.#name(this.#stage);
    if (this.#trial?.scene) this.#describe(this.#trial);
  }

  /** @param {Stage} stage */
  #show(stage) {
    this.#trial?.end();
    this.#stage = stage;
    this.#trial = isTrial(stage) ? new Trial(stage) : null;
    this.page.showState("");
    document.body.classList.add("study");
    document.body.classList.toggle("reading", !this.#trial);
    find("#study-page").hidden = this.#trial !== null;
    find("#task").hidden = !this.#trial;
    find("#withdraw").hidden = !canWithdraw(stage);
    this.page.labels.inWords = true;
    if (stage.stage === "withdrawn") this.page.connection.forget();
    this.#name(stage);
    if (isTrial(stage)) this.pages.hide();
    else {
      this.page.quiet();
      this.pages.show(stage);
    }
  }

  /** @param {Stage} stage */
  #name({ title }) {
    find("h1").textContent = document.title = inLanguage(title);
  }

  /** @param {Trial} trial */
  #describe(trial) {
    find("#task-title").textContent = trial.title;
    find("#task-item").textContent = trial.task;
    this.page.labels.desire(trial.stage.desired, text("desired_here"));
  }

  /** @param {Trial} trial @param {ServerMessage} message */
  #play(trial, message) {
    switch (message.type) {
      case "welcome":
        return this.#set(trial, message);
      case "countdown":
        return this.#countDown(trial, message);
      case "begin":
        return this.#begin(trial, message);
      case "decided":
        return trial.decide(message);
      case "say":
        return isQuestion(message) ? this.page.voice.announce(trial.question) : undefined;
      case "ended":
        return this.#end(trial, message);
    }
  }

  /** @param {Trial} trial @param {Welcome} message */
  #set(trial, { scene, asked }) {
    trial.scene = scene;
    this.page.view?.encircle(trial.stage.desired);
    this.#describe(trial);
    for (const selector of ["#countdown", "#give-up", "#next"]) find(selector).hidden = true;
    enable(this.#ready, !trial.stage.running);
    this.#letTalk(false, "not_yet");
    find("#task-title").focus();
    if (!asked) return;
    trial.about = asked;
    this.page.voice.announce(trial.question);
  }

  /** @param {Trial} trial @param {Countdown} message */
  #countDown(trial, { seconds }) {
    this.#ready.hidden = true;
    find("#countdown").hidden = seconds < 0.5;
    trial.countDown(seconds, (left) => {
      find("#countdown").textContent = String(left);
      this.page.voice.announce(String(left));
    });
  }

  /** @param {Trial} trial @param {Begin} message */
  #begin(trial, { t }) {
    const { running } = trial.stage;
    trial.begin(t, () => enable(this.#giveUp, true));
    find("#countdown").hidden = true;
    this.#letTalk(true, "own_words");
    if (!running) this.page.voice.show("greeting", 4000);
    if (!running || document.activeElement === document.body || document.activeElement === find("#task-title"))
      find("#say").focus();
  }

  /** @param {Trial} trial @param {Ended} message */
  #end(trial, { picked }) {
    trial.end();
    this.#giveUp.hidden = true;
    this.#letTalk(false, "over");
    const line = trial.outcome(picked);
    find("#outcome").textContent = line;
    find("#end").hidden = false;
    enable(this.#next, true);
    this.#next.focus();
    this.page.voice.announce(line);
  }

  /** @param {boolean} now @param {string} note */
  #letTalk(now, note) {
    for (const control of find("#talk", HTMLFormElement).elements) control.toggleAttribute("disabled", !now);
    find("#say", HTMLInputElement).placeholder = text(note);
  }

  /** @param {"ready" | "next" | "give_up"} type @param {HTMLButtonElement} button */
  #send(type, button) {
    button.disabled = true; // a second click is none
    this.page.connection.send({ type });
  }
}

/** @param {HTMLButtonElement} button @param {boolean} shown */
function enable(button, shown) {
  button.hidden = !shown;
  button.disabled = false;
}
