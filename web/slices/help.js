// The keys of the page of slices.

import { html, render } from "../shared/dom.js";

/** @type {Array<[string, string]>} */
const KEYS = [
  ["[ or Page down", "One step back"],
  ["] or Page up", "One step forward"],
  ["H V F", "Horizontal, vertical, free plane"],
  ["+ −", "Twice as thick, half as thick"],
  ["C", "Next color"],
  ["M", "Measure: two points"],
  ["R", "Points on fitted surfaces, as measured, or only those left out"],
  ["0", "Whole slice"],
  ["Arrows", "Pan the slice, when it has the focus"],
  ["Enter", "Pick the point in the middle"],
  ["Esc", "End measuring, and drawing a polygon"],
];

export function help(/** @type {HTMLElement} */ dialog) {
  render(
    html`<h2 id="help-title">Keys</h2>
      <dl class="keys">
        ${KEYS.map(
          ([key, text]) =>
            html`<div>
              <dt>${key}</dt>
              <dd>${text}</dd>
            </div>`,
        )}
      </dl>
      <p>
        ${
          "On the map from above: drag for a vertical slice, drag its line or its ends A and B. " +
          "The arrow shows the viewing direction."
        }
      </p>
      <form method="dialog"><button class="primary">Close</button></form>`,
    dialog,
  );
}
