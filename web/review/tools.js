// The buttons and keys of the review page: how each action is called.

import { keep, kept } from "../shared/address.js";
import { make } from "../shared/dom.js";
import { listenToKeys } from "./keys.js";

const GO_ON = "recon4-review-go-on"; // whether this browser goes on after a decision

/** A double click acts once: its second click would hit the next pair. */
const once = (action) => (event) => event.detail < 2 && action();

const button = (text, key, action, className = "") =>
  make(
    "button",
    { type: "button", className, onclick: action, title: `${text} (${key})` },
    make("span", {}, text),
    make("kbd", {}, key),
  );

const makeButtons = (act) => ({
  previous: button("Previous", "K", act.previous),
  next: button("Next", "J", act.next),
  accept: button("Accept", "A", once(act.accept), "yes"),
  reject: button("Reject", "R", once(act.reject), "no"),
  restore: button("Restore", "U", act.restore),
  refine: button("Refine", "Enter", act.refine),
  pick: button("Pick points", "P", act.pick),
  undo: button("Undo", "Ctrl Z", act.undo),
  redo: button("Redo", "Ctrl Y", act.redo),
  add: button("Add loop", "L", act.add),
  keys: button("Keys", "?", act.keys),
});

/**
 * Fills the bar below the pair and adds to that of the queue; returns the buttons by action, the
 * field `reason`, and the check box `goOn` to the next pair after a decision.
 */
export function makeTools(bar, queueBar, act) {
  const buttons = makeButtons(act);
  const { previous, reject, accept, next, restore, refine, pick, undo, redo } = buttons;
  const reason = make("input", {
    autocomplete: "off",
    maxLength: 500,
    placeholder: "Reason (optional)",
    ariaLabel: "Reason",
  });
  const goOn = make("input", { type: "checkbox", checked: kept(GO_ON) === "yes" });
  goOn.addEventListener("change", () => keep(GO_ON, goOn.checked ? "yes" : "no"));
  const text = make("span", {}, "Go on to the next pair after a decision");
  bar.append(
    make("div", { className: "row main" }, previous, reject, accept, next),
    make("div", { className: "row" }, restore, refine, pick, undo, redo),
    make(
      "div",
      { className: "row reason" },
      reason,
      make("label", { className: "check" }, goOn, text),
    ),
  );
  queueBar.append(buttons.add, buttons.keys);
  return { buttons, reason, goOn };
}

/** Actions by key. */
const keyActions = (act, view, reason) => ({
  j: act.next,
  k: act.previous,
  a: act.accept,
  r: act.reject,
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

/** Movements of the second place by key, in meters and radians. */
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

/** Calls the actions by key; the second place moves by key while `canMove()`. */
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
