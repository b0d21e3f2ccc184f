// Sensors, disk, batteries and warnings: at a glance on the page, and every figure in a sheet.

import { make } from "../shared/dom.js";
import { chips, lidarRow, lostWords, supplies } from "./captions.js";

const byId = (id) => document.getElementById(id);
const shown = new Map();
const NO_POINTS = {
  level: "info",
  text: "This browser cannot draw points (no WebGL 2); plan, way and warnings work",
};
const SHORT_PX = 700;
let bad = new Set();

/** Fills an element anew only if what it says is something else: ten messages a second come. */
export function say(element, items, show) {
  const key = JSON.stringify(items);
  if (shown.get(element) === key) return;
  shown.set(element, key);
  element.replaceChildren(...items.map(show));
}

/** Shows how everything is; `battery` is the phone's. */
export function drawHealth({ scene, linked, battery, drawsPoints }) {
  const { state, newest } = scene;
  const found = chips(newest, state, battery);
  byId("sensors").hidden = found.length === 0;
  byId("sensors").classList.toggle("old", !linked);
  say(byId("sensors"), found, (one) =>
    make("span", { className: one.bad ? "bad" : "" }, one.words),
  );
  const words = linked
    ? [...(newest.words ?? []), ...(drawsPoints ? [] : [NO_POINTS])]
    : [lostWords(state, scene.silentS)];
  drawWords(words);
  if (byId("health").open) drawSheet(newest, words, battery);
}

function drawWords(words) {
  const most = innerHeight < SHORT_PX ? 2 : 3;
  const more = words.length - most;
  say(byId("words"), more > 0 ? [...words.slice(0, most), { more }] : words, (word) =>
    word.more ? moreOf(word.more) : line(word),
  );
  shake(words.filter((word) => word.level === "bad"));
}

const line = ({ level, text }) => make("li", { className: level }, text);
const moreOf = (count) =>
  make(
    "li",
    { className: "more" },
    make("button", { type: "button", onclick: () => byId("sensors").click() }, `and ${count} more`),
  );

/** Who walks does not look all the time: a new grave warning shakes the phone, where it can. */
function shake(words) {
  const kinds = new Set(words.map(({ text }) => text.replace(/\d+/g, "#")));
  if ([...kinds].some((kind) => !bad.has(kind)) && navigator.userActivation?.hasBeenActive)
    navigator.vibrate?.([120, 80, 120]);
  bad = kinds;
}

/** Opens the sheet. */
export function showHealth({ scene, battery }) {
  byId("health").showModal();
  drawSheet(scene.newest, scene.newest.words ?? [], battery);
}

function drawSheet(newest, words, battery) {
  say(byId("all-words"), words, line);
  const cell = (text, k) =>
    make(k ? "td" : "th", { className: k === 1 || k === 2 ? "number" : "" }, text);
  say(byId("lidars"), (newest.lidars ?? []).map(lidarRow), (row) =>
    make("tr", {}, ...row.map(cell)),
  );
  say(byId("supplies"), supplies(newest, battery), ([what, figure]) =>
    make("div", {}, make("dt", {}, what), make("dd", {}, figure)),
  );
}
