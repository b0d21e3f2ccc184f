// A field for a number in the panel of the map.

import { html, targetOf } from "../shared/dom.js";

/** A field for a number; empty = null. */
export const numberField = (
  /** @type {string} */ label,
  /** @type {number | null} */ value,
  /** @type {(value: number | null) => void} */ set,
  { step = 0.1, usual = "" } = {},
) =>
  html`<label
    ><span>${label}</span
    ><input
      type="number"
      step=${step}
      placeholder=${usual}
      .value=${value === null ? "" : String(Number(value.toFixed(4)))}
      @change=${(/** @type {Event} */ event) => {
        const text = targetOf(event).value;
        set(text === "" || !Number.isFinite(Number(text)) ? null : Number(text));
      }}
  /></label>`;
