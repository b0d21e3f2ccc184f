// Buttons and dialogs of the operator's page: start, mark, pause, stop, make the map.

import { keep, kept } from "../shared/address.js";
import {
  markHere,
  projectUrl,
  readCaptureChoices,
  startCapture,
  steerCapture,
} from "../shared/api.js";
import { attempt, byId, make } from "../shared/dom.js";

const LONGEST_NOTE_S = 600;

/** A dialog with a form; it closes when `act(form)` succeeds. */
function dialog(id, act) {
  const element = byId(id, HTMLDialogElement);
  const form = element.querySelector("form");
  const message = element.querySelector(".error");
  form.querySelector(".cancel")?.addEventListener("click", () => element.close());
  form.addEventListener("submit", async (event) => {
    const submitter = /** @type {HTMLButtonElement | null} */ (event.submitter);
    if (submitter?.value === "cancel") return;
    event.preventDefault();
    const text = submitter?.textContent ?? "";
    if (submitter) [submitter.disabled, submitter.textContent] = [true, "One moment…"];
    const done = await attempt(message, () => act(form));
    if (submitter) [submitter.disabled, submitter.textContent] = [false, text];
    if (done !== undefined) element.close();
  });
  return () => {
    message.textContent = "";
    if (!element.open) element.showModal();
  };
}

const showStart = dialog("begin", ({ rig, preset, place }) => {
  keep(LAST, JSON.stringify({ rig: rig.value, preset: preset.value }));
  return startCapture({ rig: rig.value, preset: preset.value, place: place.value });
});
const showMark = dialog("note", (form) => {
  const ago = Math.max(0, (performance.now() - touched) / 1000);
  return markHere({ text: form.text.value, ago_s: Math.min(ago, LONGEST_NOTE_S) });
});
const showName = dialog("naming", (form) => markHere({ what: "place", text: form.text.value }));
const showEnd = dialog("ending", () => steerCapture("stop"));

let touched = 0; // time of the Mark button; the operator walks on while typing

const LAST = "recon4.live.last";

/** The last choices on this phone. */
const lastChosen = () => JSON.parse(kept(LAST) ?? "{}");

/** Fills a select and restores the last choice. */
function offer(select, options, last) {
  select.replaceChildren(...options);
  const usable = options.filter((option) => !option.disabled);
  select.value = (usable.find((option) => option.value === last) ?? usable[0]).value;
}

async function begin() {
  const form = byId("begin").querySelector("form");
  const choices = await attempt(byId("message"), readCaptureChoices);
  if (!choices) return;
  const rig = ({ rig: value, name, sensors, problem }) =>
    make(
      "option",
      { value, disabled: problem !== "" },
      `${name}: ${problem || sensors.join(", ")}`,
    );
  offer(form.rig, choices.rigs.map(rig), lastChosen().rig);
  offer(
    form.preset,
    choices.presets.map((name) =>
      make("option", { value: name }, `${name}: ${choices.preset_texts[name]}`),
    ),
    lastChosen().preset,
  );
  const now = new Date(Date.now() - 60_000 * new Date().getTimezoneOffset()).toISOString();
  form.place.value = `Walk ${now.slice(0, 16).replace("T", " ")}`;
  showStart();
}

export function mark() {
  if (!byId("note", HTMLDialogElement).open) touched = performance.now();
  byId("note").querySelector("form").reset();
  showMark();
}

export const nameThePlace = () => (byId("more", HTMLDialogElement).close(), showName());

function stop(text) {
  byId("ending-words").textContent = text;
  showEnd();
}

async function makeMap() {
  const view = await attempt(byId("message"), () => steerCapture("process"));
  if (view) location.assign(projectUrl(view.job.project));
}

let shown = "";

/** Shows the buttons of a state; none to a user without the permission. */
export function drawActions({ state, project, mayCapture, linked, loop }) {
  const key = `${state}/${mayCapture}/${project}/${linked}`;
  if (key === shown) return;
  shown = key;
  const button = (text, className, onclick) =>
    make("button", { type: "button", className, onclick, disabled: !linked }, text);
  const steer = (what) => () => attempt(byId("message"), () => steerCapture(what));
  const atStart = () =>
    loop()?.closed
      ? "The loop is closed."
      : "The loop is not closed yet: the map is better if you return to the start first.";
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
