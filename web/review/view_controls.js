// The controls of <pair-view>: what can be chosen, and how it is drawn.

import { html } from "../shared/dom.js";
import { t } from "../shared/texts.js";

/**
 * @import {Content} from "../shared/dom.js"
 * @typedef {"above" | "side" | "free" | "cut"} View
 * @typedef {"odometry" | "predicted" | "after"} Shown
 */

/** @type {Array<[View, string]>} */
export const VIEWS = [
  ["above", "view-above"],
  ["side", "view-side"],
  ["free", "view-free"],
  ["cut", "view-cut"],
];
/** @type {Array<[Shown, string]>} */
export const SHOWN = [
  ["odometry", "view-odometry"],
  ["predicted", "view-predicted"],
  ["after", "view-after"],
];
export const REACHES = [0, 2, 5, 10];
/**
 * The next of some choices.
 * @template T
 * @param {Array<[T, string]>} choices
 * @param {T} now
 */
export const after = (choices, now) =>
  /** @type {[T, string]} */ (
    choices[(choices.findIndex(([key]) => key === now) + 1) % choices.length]
  )[0];

/**
 * Buttons of which one is pressed.
 * @template {string} T
 * @param {string} label
 * @param {Array<[T, string]>} choices
 * @param {T} chosen
 * @param {(key: T) => void} choose
 */
export const group = (label, choices, chosen, choose) =>
  html`<div role="group" aria-label=${label} class="segmented">
    ${choices.map(
      ([name, text]) =>
        html`<button type="button" aria-pressed=${name === chosen} @click=${() => choose(name)}>
          ${t(text)}
        </button>`,
    )}
  </div>`;

/**
 * @param {string} name
 * @param {Content} text
 */
export const key = (name, text) => html`<span class="key ${name}">${text}</span>`;
