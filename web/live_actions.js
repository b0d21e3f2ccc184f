// The buttons of the operator's page and the dialogs they open: start, mark, pause, stop, make the map.

import { markHere, projectUrl, readChoices, startCapture, steerCapture } from "./api.js";
import { attempt, make } from "./dom.js";

const byId = (id) => document.getElementById(id);

/** A dialog whose form asks for something; it closes once `act(form)` went well. */
function dialog(id, act) {
  const element = byId(id);
  const form = element.querySelector("form");
  const message = element.querySelector(".error");
  form.addEventListener("submit", async (event) => {
    if (event.submitter?.value === "cancel") return;
    event.preventDefault();
    if (event.submitter) event.submitter.disabled = true;
    const done = await attempt(message, () => act(form));
    if (event.submitter) event.submitter.disabled = false;
    if (done !== undefined) element.close();
  });
  return () => {
    message.textContent = "";
    if (!element.open) element.showModal();
  };
}

const showStart = dialog("begin", ({ project, rig, preset, place }) =>
  startCapture({ project: project.value, rig: rig.value, preset: preset.value, place: place.value }));
const showMark = dialog("note", (form) => markHere({ text: form.text.value }));
const showName = dialog("naming", (form) => markHere({ what: "place", text: form.text.value }));
const showEnd = dialog("ending", () => steerCapture("stop"));

async function begin() {
  const form = byId("begin").querySelector("form");
  const choices = await attempt(byId("message"), readChoices);
  if (!choices) return;
  const option = (name) => make("option", { value: name }, name);
  form.rig.replaceChildren(...choices.rigs.map(option));
  form.preset.replaceChildren(...choices.presets.map(option));
  const now = new Date(Date.now() - 60_000 * new Date().getTimezoneOffset()).toISOString();
  form.project.value = `walk-${now.slice(0, 16).replace(/[:T]/g, "-")}`;
  showStart();
}

export function mark() {
  byId("note").querySelector("form").reset();
  showMark();
}

export const nameThePlace = () => (byId("more").close(), showName());

function stop(words) {
  byId("ending-words").textContent = words;
  showEnd();
}

async function makeMap() {
  const view = await attempt(byId("message"), () => steerCapture("process"));
  if (view) location.assign(projectUrl(view.job.project));
}

let shown = "";

/** Shows what can be done in a state; nothing to who only looks on. */
export function drawActions({ state, project, mayCapture, linked, loop }) {
  const key = `${state}/${mayCapture}/${project}/${linked}`;
  if (key === shown) return;
  shown = key;
  const button = (words, className, onclick) => make("button", { type: "button", className, onclick, disabled: !linked }, words);
  const steer = (what) => () => attempt(byId("message"), () => steerCapture(what));
  const atStart = () => (loop()?.closed ? "The loop is closed." : "The loop is not closed yet: the map is better if you return to the start first.");
  const end = button("Stop", "stop", () => stop(atStart()));
  const rows = {
    none: () => [button("Start…", "primary", begin)],
    recording: () => [button("Mark", "", mark), button("Pause", "", steer("pause")), end],
    paused: () => [button("Resume", "primary", steer("resume")), end],
    ready: () => [
      make("a", { className: "button", href: projectUrl(project) }, "Project"),
      button("Make the map", "primary", makeMap),
      button("New…", "", begin),
    ],
  };
  byId("actions").replaceChildren(...(mayCapture ? (rows[state]?.() ?? []) : []));
}
