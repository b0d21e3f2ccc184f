// The controls of <pair-view>: what can be chosen, and how it is drawn.

import { html } from "../shared/dom.js";

/**
 * @import {Content} from "../shared/dom.js"
 * @typedef {"above" | "side" | "free" | "cut"} View
 * @typedef {"odometry" | "predicted" | "after"} Shown
 */

/** @type {Array<[View, string]>} */
export const VIEWS = [
  ["above", "Above"],
  ["side", "Side"],
  ["free", "Free"],
  ["cut", "Cut"],
];
/** @type {Array<[Shown, string]>} */
export const SHOWN = [
  ["odometry", "Odometry"],
  ["predicted", "Graph"],
  ["after", "Aligned"],
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
          ${text}
        </button>`,
    )}
  </div>`;

/**
 * @param {string} name
 * @param {Content} text
 */
export const key = (name, text) => html`<span class="key ${name}">${text}</span>`;
