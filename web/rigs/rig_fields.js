// Groups and captions of the fields of a rig.

import { html, targetOf } from "../shared/dom.js";

/**
 * @import {Content} from "../shared/dom.js"
 * @typedef {{label: string, path: string}} Label a caption, and the name of the field
 */

/**
 * @param {string} title
 * @param {Content[]} children
 */
export const group = (title, children) =>
  html`<fieldset>
    <legend>${title}</legend>
    ${children}
  </fieldset>`;

/**
 * @param {Label} label
 * @param {Record<string, string>} options captions by value
 * @param {string} chosen
 * @param {(value: string) => void} set
 */
export function choice({ label, path }, options, chosen, set) {
  const select = html`<select
    name=${path}
    @change=${(/** @type {Event} */ event) => set(targetOf(event).value)}
  >
    ${Object.entries(options).map(
      ([value, text]) =>
        html`<option value=${value} .selected=${value === chosen}>${text}</option>`,
    )}
  </select>`;
  return labeled(label, path, select);
}

/**
 * @param {string} label
 * @param {string} path
 * @param {Content} control
 */
export const labeled = (label, path, control) =>
  html`<label><span>${label}</span>${control}${slot(path)}</label>`;

export const slot = (/** @type {string} */ path) =>
  html`<small class="error" data-problem=${path}></small>`;
