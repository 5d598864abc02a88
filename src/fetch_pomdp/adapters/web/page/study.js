// A study: from consent to completion code, and each trial from the ring around an item to what the robot brought.

import { described } from "./names.js";
import { inLanguage, Paper } from "./study-pages.js";
import { text } from "./texts.js";

const $ = (selector) => document.querySelector(selector);
const TRIALS = ["practice", "trials"];

export class Study {
  constructor(page) {
    this.page = page; // connection, stage, labels, announce, bubble, choose
    this.on = false;
    this.paper = new Paper($("#paper"), page.connection, (language) => page.choose(language));
    $("#ready").addEventListener("click", () => this.#send("ready", "#ready"));
    $("#next").addEventListener("click", () => this.#send("next", "#next"));
    $("#give-up").addEventListener("click", () => this.#send("give_up", "#give-up"));
    $("#withdraw").addEventListener("click", () => $("#leaving").showModal());
    $("#leave").addEventListener("click", () => page.connection.withdraw());
  }

  // Know of a message that the page has dealt with.
  told(message) {
    ({
      stage: this.#stage, welcome: this.#welcome, countdown: this.#countdown, begin: this.#begin, heard: this.#heard,
      decided: this.#decided, say: this.#said, ended: this.#ended, error: this.#error,
    })[message.type]?.call(this, message);
  }

  // Another language was chosen.
  again() {
    if (!this.on) return;
    this.paper.again();
    this.#name();
  }

  #stage(message) {
    this.on = true;
    const trial = TRIALS.includes(message.stage);
    this.message = message;
    this.scene = null;
    this.page.show("");
    document.body.classList.add("study");
    document.body.classList.toggle("reading", !trial);
    $("#paper").hidden = trial;
    $("#task").hidden = !trial;
    $("#withdraw").hidden = ["withdrawn", "declined", "full"].includes(message.stage);
    this.page.labels.described = described;
    if (message.stage === "withdrawn") this.page.connection.forget();
    this.#name();
    clearInterval(this.counting);
    clearTimeout(this.giving);
    if (trial) this.paper.hide();
    else {
      this.page.quiet();
      this.paper.show(message);
    }
  }

  #name() {
    const { title } = this.message;
    $("h1").textContent = document.title = inLanguage(title);
    if (this.scene && TRIALS.includes(this.message.stage)) this.#describe();
  }

  #describe() {
    const { stage, order, of, desired } = this.message;
    const item = this.scene.items.find((each) => each.id === desired);
    $("#task-title").textContent = text(stage === "practice" ? "round_practice" : "round", { round: order + 1, of });
    $("#task-item").textContent = text("desired", { item: described(item, this.scene) });
    this.page.labels.desire(desired, text("desired_here"));
  }

  #welcome(message) {
    if (!this.on) return;
    this.scene = message.scene;
    this.page.stage?.encircle(this.message.desired);
    this.#describe();
    for (const selector of ["#countdown", "#give-up", "#next"]) $(selector).hidden = true;
    this.#enable("#ready", !this.message.running);
    this.#talking(false, "not_yet");
    $("#task-title").focus();
    if (message.asked) {
      this.about = message.asked;
      this.page.stage?.ask(message.asked);
      $("#answers").hidden = false;
      this.page.bubble("asks", null);
      this.page.labels.about(message.asked);
      this.#said({ key: "asks" });
    }
  }

  #countdown({ seconds }) {
    $("#ready").hidden = true;
    $("#countdown").hidden = seconds < 0.5;
    let left = Math.ceil(seconds);
    const count = () => {
      $("#countdown").textContent = left;
      this.page.announce(String(left));
      left -= 1;
    };
    count();
    this.counting = setInterval(() => { if (left > 0) count(); }, 1000);
  }

  #begin({ t }) {
    clearInterval(this.counting);
    $("#countdown").hidden = true;
    this.#talking(true, "own_words");
    if (!this.message.running) this.page.bubble("greeting", 4000);
    if (!this.message.running || document.activeElement === document.body || document.activeElement === $("#task-title")) $("#say").focus();
    this.giving = setTimeout(() => this.#enable("#give-up", true), (this.message.give_up - t) * 1000);
  }

  #heard() {
    if (!$("#answers").hidden) $("#bubble").hidden = true;
    $("#answers").hidden = true;
    this.page.stage?.rest();
  }

  #decided({ action, item }) {
    if (this.on && action !== "wait") this.about = item;
  }

  // Who does not see the table is told what the robot points at.
  #said({ key }) {
    if (!this.on || key !== "asks") return;
    const item = this.scene.items.find((each) => each.id === this.about);
    this.page.announce(text("points_at", { item: described(item, this.scene) }));
  }

  #ended({ picked }) {
    if (!this.on) return;
    clearTimeout(this.giving);
    $("#give-up").hidden = true;
    this.#talking(false, "over");
    const item = this.scene.items.find((each) => each.id === picked);
    const line = item ? text("brought", { item: described(item, this.scene) }) : text("brought_none");
    $("#outcome").textContent = line;
    $("#end").hidden = false;
    this.#enable("#next", true);
    $("#next").focus();
    this.page.announce(line);
  }

  #error() {
    for (const selector of ["#ready", "#next", "#give-up"]) $(selector).disabled = false;
  }

  #talking(now, note) {
    for (const control of $("#talk").elements) control.disabled = !now;
    if (!now) $("#answers").hidden = true;
    $("#say").placeholder = text(note);
  }

  #enable(selector, shown) {
    $(selector).hidden = !shown;
    $(selector).disabled = false;
  }

  #send(type, selector) {
    $(selector).disabled = true; // a second click is none
    this.page.connection.send({ type });
  }
}
