// Why the robot acts, in a sentence: the server's own in English, and one from the same numbers in other languages
// (texts.json has the English pieces too, for translators to start from).

import { allEqual } from "./shares.js";
import { decimal, isEnglish, join, percent, text } from "./texts.js";

const TELLING = Math.log(2); // log-odds from which evidence is worth a word, as the server has it
const NEAR = Math.log(1.5); // below, two items are almost equally likely
const CERTAIN = 0.9995;

export function why(decided, belief) {
  const { explanation } = decided;
  if (isEnglish()) return `${explanation.sentence[0].toUpperCase()}${explanation.sentence.slice(1)}.`;
  return `${deed(decided)}: ${known(decided, belief)}. ${worths(explanation.values)}.`;
}

function deed({ action, item }) {
  return text({ wait: "waits", point: "asks_about", pick: "picks" }[action], { item });
}

// How the item that the decision is about stands to its rival, and where that comes from.
function known({ action, item: about, explanation }, shares) {
  const { item, rival, belief, log_odds: odds, unanswered } = explanation;
  if (unanswered && (action === "wait" || unanswered === about)) return text("why_unanswered", { item: unanswered });
  if (allEqual(shares)) return text("evenly");
  if (!rival) return text("why_alone", { item });
  if (belief >= CERTAIN) return text("why_certain", { item });
  if (odds.total === null) return text("why_likely", { item, percent: percent(belief) });
  if (Math.min(odds.words, odds.pointing) <= -TELLING && Math.max(odds.words, odds.pointing) >= TELLING) {
    const [said, shown] = odds.words > 0 ? [item, rival] : [rival, item];
    return text("why_torn", { said, shown, words: ratio(odds.words), pointing: ratio(odds.pointing) });
  }
  if (Math.abs(odds.total) < NEAR) return text("why_alike", { items: join([item, rival]) });
  const [likelier, other] = odds.total > 0 ? [item, rival] : [rival, item];
  const lead = text("why_times", { likelier, other, ratio: ratio(odds.total), percent: percent(explanation.belief), item });
  return lead + source(odds);
}

function source(odds) {
  const [most, key] = [[odds.words, "why_words"], [odds.answers, "why_answers"], [odds.pointing, "why_pointing"]].sort((one, other) => other[0] - one[0])[0];
  return most >= TELLING && most > odds.total / 2 ? text(key) : "";
}

function ratio(odds) {
  const times = Math.exp(Math.abs(odds));
  return times > 1000 ? text("why_thousand") : String(Number(times.toPrecision(2))).replace(".", decimal(0.5)[1]);
}

function worths(values) {
  const names = { wait: "waiting", point: "asking", pick: "picking" };
  const valued = Object.entries(values).filter(([, option]) => option.value !== null).sort((one, other) => other[1].value - one[1].value);
  return text("why_worth", { options: join(valued.map(([kind, option]) => `${text(names[kind])} ${decimal(option.value)}`)) });
}
