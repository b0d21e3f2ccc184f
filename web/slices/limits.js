// The limits of a job at its control and check points. No network.

import { fields, html } from "../shared/dom.js";

/** @import {LimitsSpec} from "../shared/http_types" */

/** @type {Array<[keyof LimitsSpec, string]>} */
const FIELDS = [
  ["mean_horizontal_m", "Mean horizontal"],
  ["mean_height_m", "Mean height"],
  ["max_horizontal_m", "Largest horizontal"],
  ["max_height_m", "Largest height"],
  ["distances_m", "Distances between points"],
  ["survey_sd_m", "Standard deviation of survey and picking"],
];

const centimeters = (/** @type {number | null | undefined} */ limit) =>
  limit === null || limit === undefined ? "" : String(Number((limit * 100).toPrecision(6)));

/**
 * The form of the limits; `keep(limits)` when a person sets them, null = the usual ones.
 * @param {LimitsSpec} limits
 * @param {string} text
 * @param {(limits: LimitsSpec | null) => unknown} keep
 */
export function limitsForm(limits, text, keep) {
  const submit = (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    const given = fields(/** @type {HTMLFormElement} */ (event.currentTarget));
    const valueOf = (/** @type {string} */ key) => {
      const { value, valueAsNumber } = given[key];
      return value === "" ? null : Number((valueAsNumber / 100).toPrecision(9));
    };
    keep(Object.fromEntries(FIELDS.map(([key]) => [key, valueOf(key)])));
  };
  const input = (/** @type {keyof LimitsSpec} */ key, /** @type {string} */ label) =>
    html`<label
      ><span>${label} [cm]</span
      ><input
        type="number"
        min="0.1"
        max="10000"
        step="any"
        name=${key}
        placeholder="not required"
        aria-label="${label} [cm]"
        ?required=${key === "survey_sd_m"}
        .value=${centimeters(limits[key])}
    /></label>`;
  return html`<details>
    <summary>Limits: ${text}</summary>
    <p class="quiet">
      They hold for this project, and stand on the sheet and in the CSV. Empty = not required. A
      residual more than 3 standard deviations of survey and map together is flagged.
    </p>
    <form class="limits" @submit=${submit}>
      ${FIELDS.map(([key, label]) => input(key, label))}
      <div class="buttons">
        <button>Set limits</button
        ><button type="button" @click=${() => keep(null)}>Usual limits</button>
      </div>
    </form>
  </details>`;
}
