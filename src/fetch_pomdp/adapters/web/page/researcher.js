// The researcher's page: how far everybody is, again and again, and all that was kept as a ZIP file.

import { chosenLanguage, currentLanguage, setLanguage, text } from "./texts.js";

const $ = (selector) => document.querySelector(selector);
const PERIOD = 5000; // ms
const token = new URLSearchParams(location.hash.slice(1)).get("token");
let shown = null;

const ask = (path) => fetch(path, { headers: { authorization: `Bearer ${token}` }, cache: "no-store" });

async function refresh() {
  let again = true;
  try {
    const answer = await ask("researcher/progress");
    again = answer.status !== 401 && answer.status !== 404;
    if (answer.ok) show(await answer.json());
    else $("#state").textContent = text(answer.status === 401 ? "researcher_wrong" : answer.status === 404 ? "researcher_key" : "researcher_lost");
  } catch {
    $("#state").textContent = text("researcher_lost");
  }
  if (again) setTimeout(refresh, PERIOD);
}

function show(study) {
  shown = study;
  const { title, people, progress } = study;
  $("h1").textContent = document.title = `${title[currentLanguage()] ?? title.en}: ${text("researcher")}`;
  const count = (which) => progress.filter(which).length;
  const line = text("researcher_people", { there: progress.length, people, done: count((one) => one.stage === "done"), idle: count((one) => one.of > 0 && one.trials_done === 0) });
  if ($("#state").textContent !== line) $("#state").textContent = line; // what stays the same is not read aloud again
  $("#export").disabled = progress.length === 0;
  $("#nobody").hidden = progress.length > 0;
  $("tbody").replaceChildren(...progress.map(row));
}

function row(one) {
  const made = document.createElement("tr"), head = document.createElement("th");
  head.scope = "row";
  head.textContent = one.person;
  made.append(head);
  for (const value of [one.code, text(`stage_${one.stage}`), `${one.trials_done} / ${one.of}`, one.interruptions, one.given_up, time(one.joined), time(one.last)]) {
    made.insertCell().textContent = value;
  }
  return made;
}

const time = (iso) => new Intl.DateTimeFormat(currentLanguage(), { dateStyle: "short", timeStyle: "short" }).format(new Date(iso));

async function save() {
  $("#export").disabled = true;
  $("#state").textContent = text("exporting");
  try {
    const answer = await ask("researcher/export");
    if (!answer.ok) throw new Error(answer.statusText);
    const link = document.createElement("a");
    link.href = URL.createObjectURL(await answer.blob());
    link.download = `${shown.name}.zip`;
    link.click();
    URL.revokeObjectURL(link.href);
    show(shown);
  } catch {
    $("#state").textContent = text("researcher_lost");
    $("#export").disabled = false;
  }
}

function choose(language) {
  setLanguage(language);
  $("#language").value = language;
  if (shown) show(shown);
}

$("#language").addEventListener("change", () => choose($("#language").value));
$("#export").addEventListener("click", save);
choose(chosenLanguage());
if (token) refresh();
else $("#state").textContent = text("researcher_key");
