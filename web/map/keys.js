// Keys of the map, without a click first.

import { targetOf } from "../shared/dom.js";
import { VIEWS } from "./views.js";

/**
 * @import {Act} from "./bar.js"
 * @typedef {object} MoreActs
 * @property {() => unknown} color the next one
 * @property {() => unknown} ceilings with or without
 * @property {() => unknown} walk shown or not
 * @property {() => unknown} press what is in the middle of the image
 * @property {(x: number, y: number) => unknown} step by a part of the image
 * @property {(times: number) => unknown} zoom nearer (below 1) or farther
 */

const OF_CONTROLS = ["Enter", " "]; // they press the control that has the focus

/**
 * @param {Act} act
 * @param {MoreActs} more
 * @returns {Record<string, () => unknown>}
 */
const keysOf = (act, more) => ({
  f: act.fit,
  o: act.parallel,
  m: () => act.tool("measure", "distance"),
  h: () => act.tool("measure", "height"),
  a: () => act.tool("measure", "angle"),
  q: () => act.tool("measure", "area"),
  i: () => act.tool("measure", "point"),
  r: () => act.tool("measure", "profile"),
  v: () => act.tool("measure", "volume"),
  s: act.snapping,
  b: () => act.tool("box"),
  x: () => act.tool("section"),
  k: () => act.tool("brush"),
  j: () => act.tool("like"),
  g: () => act.tool("stand"),
  n: () => act.tool("note"),
  p: act.fly,
  l: act.share,
  t: act.panel,
  c: more.color,
  z: more.ceilings,
  w: more.walk,
  "+": () => more.zoom(0.8),
  "=": () => more.zoom(0.8), // the key of + without shift
  "-": () => more.zoom(1.25),
  "?": act.help,
  Escape: act.end,
  Enter: act.finish,
  Backspace: act.undoPoint,
  " ": more.press,
  ArrowLeft: () => more.step(-1, 0),
  ArrowRight: () => more.step(1, 0),
  ArrowUp: () => more.step(0, 1),
  ArrowDown: () => more.step(0, -1),
  ...Object.fromEntries(
    Object.entries(VIEWS).map(([name, { key }]) => [key, () => act.view(name)]),
  ),
});

/** Whether a key ends what is typed, so that the next one is of the map again. */
const endsTyping = (/** @type {Element} */ field, /** @type {string} */ key) =>
  key === "Escape" || (key === "Enter" && field instanceof HTMLInputElement && !field.form);

/**
 * Listens to the keys of the page; what is typed into a field stays there.
 * @param {Act} act
 * @param {MoreActs} more
 */
export function listenToKeys(act, more) {
  const keys = keysOf(act, more);
  addEventListener("keydown", (event) => {
    const typing = targetOf(event).closest?.(
      "input:not([type=checkbox], [type=range]), select, textarea",
    );
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (typing && endsTyping(typing, event.key)) act.toMap();
    if (typing && event.key !== "Escape") return;
    if (document.querySelector("dialog[open]")) return;
    const control = targetOf(event).closest?.("button, summary, a, input");
    if (control && (OF_CONTROLS.includes(event.key) || event.key.startsWith("Arrow"))) return;
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
