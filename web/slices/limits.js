// The limits of a job at its control and check points. No network.

import { fields, html } from "../shared/dom.js";
import { t } from "../shared/texts.js";

/** @import {LimitsSpec} from "../shared/http_types" */

/** @type {Array<[keyof LimitsSpec, string]>} */
const FIELDS = [
  ["mean_horizontal_m", t("mean-horizontal")],
  ["mean_height_m", t("mean-height")],
  ["max_horizontal_m", t("largest-horizontal")],
  ["max_height_m", t("largest-height")],
  ["distances_m", t("distances-between")],
  ["survey_sd_m", t("sd-survey")],
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
        placeholder=${t("not-required")}
        aria-label="${label} [cm]"
        ?required=${key === "survey_sd_m"}
        .value=${centimeters(limits[key])}
    /></label>`;
  return html`<details class="folded">
    <summary>${t("limits", { limits: text })}</summary>
    <p class="quiet">${t("limits-hold")}</p>
    <form class="limits" @submit=${submit}>
      ${FIELDS.map(([key, label]) => input(key, label))}
      <div class="buttons">
        <button>${t("set-limits")}</button
        ><button type="button" @click=${() => keep(null)}>${t("usual-limits")}</button>
      </div>
    </form>
  </details>`;
}
