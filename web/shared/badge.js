// The badge with the state of a project or job: mark and word, never color alone.

import { STATES } from "./format.js";
import { html } from "./dom.js";

export function badge(/** @type {import("./format.js").StateName} */ state) {
  const { mark, word } = STATES[state];
  return html`<span class="badge ${state}"><span aria-hidden="true">${mark}</span> ${word}</span>`;
}
