// Sensors, disk, batteries and warnings: in brief on the page, all values in a sheet.

import { byId, make } from "../shared/dom.js";
import { chips, lidarRow, linkLost, supplies } from "./captions.js";

const shown = new Map();
const NO_POINTS = {
  level: "info",
  text: "This browser cannot draw points (no WebGL 2); plan, path and warnings work",
};
const SHORT_PX = 700;
let shownErrors = new Set(); // texts without their numbers

/** Fills an element only if its items have changed: ten messages arrive per second. */
export function fill(element, items, show) {
  const key = JSON.stringify(items);
  if (shown.get(element) === key) return;
  shown.set(element, key);
  element.replaceChildren(...items.map(show));
}

/** Shows sensors and warnings; `battery` is the phone's. */
export function drawHealth({ scene, linked, battery, drawsPoints }) {
  const { state, newest } = scene;
  const found = chips(newest, state, battery);
  byId("sensors").hidden = found.length === 0;
  byId("sensors").classList.toggle("old", !linked);
  fill(byId("sensors"), found, (one) =>
    make("span", { className: one.error ? "error" : "" }, one.text),
  );
  const warnings = linked
    ? [...(newest.findings ?? []), ...(drawsPoints ? [] : [NO_POINTS])]
    : [linkLost(state, scene.silentS)];
  drawWarnings(warnings);
  if (byId("health", HTMLDialogElement).open) drawSheet(newest, warnings, battery);
}

function drawWarnings(warnings) {
  const most = innerHeight < SHORT_PX ? 2 : 3;
  const more = warnings.length - most;
  fill(byId("findings"), more > 0 ? [...warnings.slice(0, most), { more }] : warnings, (one) =>
    one.more ? moreOf(one.more) : line(one),
  );
  vibrateOnNew(warnings.filter(({ level }) => level === "error"));
}

const line = ({ level, text }) => make("li", { className: level }, text);
const moreOf = (count) =>
  make(
    "li",
    { className: "more" },
    make("button", { type: "button", onclick: () => byId("sensors").click() }, `and ${count} more`),
  );

/** Vibrates for a new error, because the operator does not always look at the phone. */
function vibrateOnNew(errors) {
  const kinds = new Set(errors.map(({ text }) => text.replace(/\d+/g, "#")));
  if ([...kinds].some((kind) => !shownErrors.has(kind)) && navigator.userActivation?.hasBeenActive)
    navigator.vibrate?.([120, 80, 120]);
  shownErrors = kinds;
}

/** Opens the sheet. */
export function showHealth({ scene, battery }) {
  byId("health", HTMLDialogElement).showModal();
  drawSheet(scene.newest, scene.newest.findings ?? [], battery);
}

function drawSheet(newest, warnings, battery) {
  fill(byId("all-findings"), warnings, line);
  const cell = (text, k) =>
    make(k ? "td" : "th", { className: k === 1 || k === 2 ? "number" : "" }, text);
  fill(byId("lidars"), (newest.lidars ?? []).map(lidarRow), (row) =>
    make("tr", {}, ...row.map(cell)),
  );
  fill(byId("supplies"), supplies(newest, battery), ([name, value]) =>
    make("div", {}, make("dt", {}, name), make("dd", {}, value)),
  );
}
