// The table of slices against a reference (V Table 3.2) with signs, and its histogram. No network.

import { count } from "../shared/format.js";
import { html, nothing, svg } from "../shared/dom.js";
import { decimal, t } from "../shared/texts.js";
import { HEIGHT, bars } from "./bars.js";
import { planeText } from "./captions.js";

/** @import {ComparedSlice, Comparison} from "../shared/http_types" */

export const METHODS = { plane: t("method-plane"), point: t("method-point") };
const UNKNOWN = "–";

const cell = (/** @type {string} */ text) => html`<td class="number">${text}</td>`;
const figure = (/** @type {number | null} */ x, digits = 2) =>
  cell(x === null ? UNKNOWN : decimal(x * 100, digits));

const HEAD = [
  ...[t("head-slice"), t("head-mean"), "< 2 cm [%]", "< 5 cm [%]", t("head-signed"), "σ [cm]"],
  ...[t("head-shift-x"), t("head-shift-y"), t("head-shift-z"), t("head-points"), "> 50 cm"],
];

/**
 * @param {string} name
 * @param {ComparedSlice} one
 */
const row = (name, one) =>
  html`<tr>
    <th scope="row">${name}</th>
    ${figure(one.mean_m)} ${figure(one.ratio_within_2cm, 1)} ${figure(one.ratio_within_5cm, 1)}
    ${figure(one.signed.mean_m)} ${figure(one.signed.sd_m)}
    ${one.signed.shift_m.map((x) => figure(x))} ${cell(count(one.points))}
    ${cell(count(one.outliers))}
  </tr>`;

/**
 * The table of a comparison, its histogram, and whether the reference fits at all.
 * @param {Comparison} found
 * @param {string} csvUrl
 */
export function comparison(found, csvUrl) {
  const head = HEAD.map((text, k) => html`<th scope="col" class=${k ? "number" : ""}>${text}</th>`);
  const plain = html`<tr>
    <th scope="row">${t("mean-of-slices")}</th>
    ${figure(found.plain_mean_m)}
  </tr>`;
  const rows = [
    ...found.slices.map((one) => row(one.position ? planeText(one.position) : one.name, one)),
    row(t("mean-of-points"), found.point_weighted),
    plain,
  ];
  const tone = found.fit.fits === null ? "" : found.fit.fits ? "good" : "bad";
  return [
    html`<p class="verdict ${tone}">${found.fit.text}</p>`,
    found.fit.fits === false ? html`<p class="bad">${t("not-one-place")}</p>` : nothing,
    html`<div class="scroll">
      <table class=${found.fit.fits === false ? "unfit" : ""}>
        <thead>
          <tr>
            ${head}
          </tr>
        </thead>
        <tbody>
          ${rows}
        </tbody>
      </table>
    </div>`,
    html`<p class="quiet">
      ${t("against", {
        reference: found.reference,
        method: METHODS[found.method],
        alignment: found.alignment,
      })}
      ${found.notes.join(" ")} ${t("signed-is")}
    </p>`,
    histogram(found),
    html`<a class="button" href=${csvUrl} download="">${t("download-csv")}</a>`,
  ];
}

function histogram(
  /** @type {Comparison} */ { histogram: classes, histogram_end_m: end, histogram_step_m: step },
) {
  if (!classes.some(Boolean)) return nothing;
  const middle = classes.length / 2;
  const cm = (end * 100).toFixed(0);
  return html`<figure class="histogram">
    <figcaption>${t("histogram-of", { mm: (step * 1000).toFixed(0) })}</figcaption>
    <svg
      viewBox="0 0 ${classes.length} ${HEIGHT}"
      preserveAspectRatio="none"
      role="img"
      aria-label=${t("histogram")}
    >
      ${bars(classes).map((bar) => rect("bar", bar))}
      ${rect("zero", [middle - 0.15, 0, 0.3, HEIGHT])}
    </svg>
    <p class="scale">
      ${[`≤ −${cm} cm`, "0", `≥ ${cm} cm`].map((text) => html`<span>${text}</span>`)}
    </p>
  </figure>`;
}

/**
 * @param {string} name
 * @param {number[]} box
 */
const rect = (name, [x, y, width, height]) =>
  svg`<rect class=${name} x=${x} y=${y} width=${width} height=${height}></rect>`;
