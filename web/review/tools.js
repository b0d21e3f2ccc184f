// The buttons and keys of the review page: how each action is called.

import { keep, kept } from "../shared/address.js";
import { html, render, targetOf } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { listenToKeys } from "./keys.js";

/**
 * @import {Enabled} from "./state.js"
 * @import {PairView} from "./view.js"
 * @typedef {keyof Enabled | "drop"} ActionName
 * @typedef {Record<ActionName, () => unknown>} Actions
 * @typedef {{className?: string, action?: (event: MouseEvent) => unknown, caption?: string}} Look
 *   of a button
 * @typedef {{enabled: Enabled, refineText: string}} ToolState
 */

const GO_ON = "recon4-review-go-on"; // whether this browser goes on after a decision

/** Whether to go on to the next pair after a decision. */
export const goesOn = () => kept(GO_ON) === "yes";

/**
 * A double click acts once: its second click would hit the next pair.
 * @param {() => unknown} action
 */
const once = (action) => (/** @type {MouseEvent} */ event) => event.detail < 2 && action();

/**
 * Draws the bar below the pair, and the buttons of the queue.
 * @param {HTMLElement} bar
 * @param {HTMLElement} queueBar
 * @param {Actions} act
 * @param {ToolState} state
 */
export function drawTools(bar, queueBar, act, { enabled, refineText }) {
  const button = (
    /** @type {keyof Enabled} */ name,
    /** @type {string} */ text,
    /** @type {string} */ key,
    { className = "", action = act[name], caption = text } = /** @type {Look} */ ({}),
  ) =>
    html`<button
      type="button"
      class=${className}
      title="${text} (${key})"
      ?disabled=${!enabled[name]}
      @click=${action}
    >
      <span>${caption}</span><kbd>${key}</kbd>
    </button>`;
  const choose = (/** @type {Event} */ event) =>
    keep(GO_ON, targetOf(event).checked ? "yes" : "no");
  render(
    html`<div class="row main">
        ${button("previous", t("previous"), "K")}
        ${button("reject", t("reject"), "R", { className: "no", action: once(act.reject) })}
        ${button("accept", t("accept"), "A", { className: "yes", action: once(act.accept) })}
        ${button("next", t("next"), "J")}
      </div>
      <div class="row">
        ${button("restore", t("restore"), "U")}
        ${button("refine", t("refine"), "Enter", { caption: refineText })}
        ${button("pick", t("pick-points"), "P")} ${button("undo", t("undo"), t("key-undo"))}
        ${button("redo", t("redo"), t("key-redo"))}
      </div>
      <div class="row reason">
        <input
          autocomplete="off"
          maxlength="500"
          placeholder=${t("reason-optional")}
          aria-label=${t("reason")}
        /><label class="check"
          ><input type="checkbox" .checked=${goesOn()} @change=${choose} /><span
            >${t("go-on")}</span
          ></label
        >
      </div>`,
    bar,
  );
  render([button("add", t("add-loop"), "L"), button("keys", t("keys"), "?")], queueBar);
}

/**
 * Actions by key.
 * @param {Actions} act
 * @param {PairView} view
 * @param {HTMLElement} reason
 * @returns {Record<string, () => unknown>}
 */
const keyActions = (act, view, reason) => ({
  j: act.next,
  k: act.previous,
  a: act.accept,
  r: act.reject,
  s: act.skip,
  u: act.restore,
  Backspace: act.restore,
  p: act.pick,
  l: act.add,
  v: () => view.viewNext(),
  b: () => view.compareNext(),
  d: () => view.toggleDifference(),
  w: () => reason.focus(),
  "[": () => view.moveCut(-1),
  "]": () => view.moveCut(1),
  "+": () => view.zoom(1.25),
  "-": () => view.zoom(0.8),
  "?": act.keys,
  Enter: act.refine,
  Escape: act.drop,
});

/**
 * Movements of the second place by key, in meters and radians.
 * @param {PairView} view
 * @returns {Record<string, (m: number, turn: number) => void>}
 */
const moveActions = (view) => ({
  ArrowLeft: (m) => view.nudge(-m, 0),
  ArrowRight: (m) => view.nudge(m, 0),
  ArrowUp: (m) => view.nudge(0, m),
  ArrowDown: (m) => view.nudge(0, -m),
  PageUp: (m) => view.lift(m),
  PageDown: (m) => view.lift(-m),
  Comma: (m, turn) => view.nudge(0, 0, turn),
  Period: (m, turn) => view.nudge(0, 0, -turn),
});

/**
 * Calls the actions by key; the second place moves by key while `canMove()`.
 * @param {Actions} act
 * @param {PairView} view
 * @param {HTMLElement} reason
 * @param {() => boolean} canMove
 */
export function listenToActions(act, view, reason, canMove) {
  listenToKeys({
    press: keyActions(act, view, reason),
    moves: moveActions(view),
    undo: act.undo,
    redo: act.redo,
    reason,
    canMove,
  });
}
