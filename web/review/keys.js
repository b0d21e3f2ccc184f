// The keyboard of the review page. A key held down acts once, unless it moves, turns or zooms.

import { targetOf } from "../shared/dom.js";

const TURN = Math.PI / 180;
const REPEATING = new Set(["[", "]", "+", "-"]);
const DECIDING = new Set(["a", "r", "enter"]);
const QUIET_MS = 300; // remote desktops send a held key as presses; a person looks longer at a pair
/** The last press of a key. */
const last = { key: "", at: -Infinity };

/**
 * @typedef {object} KeyActions
 * @property {Record<string, () => unknown>} press by key
 * @property {Record<string, (m: number, turn: number) => void>} moves by code, with a step
 * @property {() => unknown} undo
 * @property {() => unknown} redo
 * @property {HTMLElement} reason the field that Enter leaves
 * @property {() => boolean} canMove
 */

/** Whether a key is held down: the browser reports a repeat, or the press follows at once. */
function isHeld(/** @type {KeyboardEvent} */ event) {
  const key = event.key.toLowerCase();
  const again = DECIDING.has(key) && key === last.key && event.timeStamp - last.at < QUIET_MS;
  Object.assign(last, { key, at: event.timeStamp });
  return event.repeat || again;
}

/**
 * Step in meters and radians of a move key, by the keys held with it.
 * @returns {[number, number]}
 */
function stepOf(/** @type {KeyboardEvent} */ event) {
  if (event.shiftKey) return [0.01, 0.1 * TURN];
  return event.altKey ? [0.5, 10 * TURN] : [0.05, TURN];
}

/**
 * @param {KeyboardEvent} event
 * @param {KeyActions} actions
 */
function onUndoKey(event, actions) {
  const key = event.key.toLowerCase();
  if (key !== "z" && key !== "y") return;
  event.preventDefault();
  if (event.repeat) return;
  if (key === "y" || event.shiftKey) actions.redo();
  else actions.undo();
}

/**
 * @param {KeyboardEvent} event
 * @param {KeyActions} actions
 */
function onMoveKey(event, actions) {
  const move = actions.moves[event.code] ?? actions.moves[event.key];
  if (!move || targetOf(event).matches("input") || !actions.canMove()) return false;
  event.preventDefault();
  move(...stepOf(event));
  return true;
}

/**
 * @param {KeyboardEvent} event
 * @param {KeyActions} given
 */
function onPressKey(event, { press }) {
  const onControl = targetOf(event).matches("button, summary, a");
  const held = isHeld(event);
  // A held Enter would press the button again and again.
  if (onControl && held) event.preventDefault();
  if (event.key === "Enter" && onControl) return;
  const action = press[event.key] ?? (event.altKey ? undefined : press[event.key.toLowerCase()]);
  if (!action) return;
  event.preventDefault();
  if (!held || REPEATING.has(event.key)) action();
}

/** Listens to the keyboard. */
export function listenToKeys(/** @type {KeyActions} */ actions) {
  document.addEventListener("keydown", (event) => {
    if (document.querySelector("dialog[open]")) return;
    if (targetOf(event).matches("input:not([type=checkbox], [type=range]), select")) {
      if (event.key === "Escape" || (event.key === "Enter" && event.target === actions.reason))
        targetOf(event).blur();
      return;
    }
    if (event.ctrlKey || event.metaKey) onUndoKey(event, actions);
    else if (!onMoveKey(event, actions)) onPressKey(event, actions);
  });
}
