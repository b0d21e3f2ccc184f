// The keys of the page of slices.

import { make } from "../shared/dom.js";

const KEYS = [
  ["[ or Page down", "One step back"],
  ["] or Page up", "One step forward"],
  ["H V F", "Horizontal, vertical, free plane"],
  ["+ −", "Twice as thick, half as thick"],
  ["C", "Next color"],
  ["M", "Measure: two points"],
  ["R", "Points on fitted surfaces, as measured, or only stray returns"],
  ["0", "Whole slice"],
  ["Arrows", "Pan the slice, when it has the focus"],
  ["Enter", "Pick the point in the middle"],
  ["Esc", "End measuring"],
];

export function help(dialog) {
  dialog.replaceChildren(
    make("h2", { id: "help-title" }, "Keys"),
    make(
      "dl",
      { className: "keys" },
      ...KEYS.map(([key, text]) => make("div", {}, make("dt", {}, key), make("dd", {}, text))),
    ),
    make(
      "p",
      {},
      "On the map from above: drag for a vertical slice, drag its line or its ends A and B. " +
        "The arrow shows the viewing direction.",
    ),
    make("form", { method: "dialog" }, make("button", { className: "primary" }, "Close")),
  );
}
