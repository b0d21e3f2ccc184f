// A list of keys and what they do, for the help of a page.

import { html } from "./dom.js";

export const keyList = (/** @type {Array<[string, string]>} */ keys) =>
  html`<dl class="keys">
    ${keys.map(
      ([key, text]) =>
        html`<div>
          <dt>${key}</dt>
          <dd>${text}</dd>
        </div>`,
    )}
  </dl>`;
