// Slices through a walk before and after a calibration, side by side.

import { html } from "../shared/dom.js";
import { t } from "../shared/texts.js";

/** @import {CalibrationSlices} from "../shared/http_types" */
/** @typedef {Array<[number, number]>} Points of a slice [m] */

const COLORS = ["#2b7de9", "#e07b1a", "#2f9e5f", "#c0458f"]; // readable on light and on dark
const SIZE = 480; // pixels of a drawing
const DOT = 1.6;
/** @type {Array<["before" | "after", string]>} */
const SIDES = [
  ["before", t("rig-file")],
  ["after", t("rig-calibrated")],
];

const colorOf = (/** @type {number} */ k) => COLORS[k % COLORS.length] ?? "";

const swatch = (/** @type {number} */ k) => html`<i .style=${`background: ${colorOf(k)}`}></i>`;

/** The two drawings with their legend. */
export function calibrationSlices(
  /** @type {CalibrationSlices} */ { lidars, thickness_m: thickness },
) {
  const reach = Math.max(
    1,
    ...lidars.flatMap(({ before, after }) => [...before, ...after].flat().map(Math.abs)),
  );
  const names = lidars.map((one) => one.name).join(t("and"));
  const cm = String(Math.round(100 * thickness));
  return html`<div class="calibration-slices">
    ${SIDES.map(([side, text]) => {
      const clouds = lidars.map((one) => one[side]);
      const label = t("rig-slice", { cm, which: text, lidars: names });
      return html`<figure>
        ${drawing(clouds, reach, label)}
        <figcaption>${text}</figcaption>
      </figure>`;
    })}
    <p class="quiet">
      ${lidars.map((one, k) => [swatch(k), ` ${one.name} `])}·
      ${t("rig-slice-size", { cm, m: (2 * reach).toFixed(0) })}
    </p>
  </div>`;
}

/**
 * @param {Points[]} clouds one a LiDAR
 * @param {number} reach from the middle to the border [m]
 * @param {string} label
 */
function drawing(clouds, reach, label) {
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: SIZE, height: SIZE, role: "img", ariaLabel: label });
  const context = canvas.getContext("2d");
  const px = SIZE / (2 * reach);
  clouds.forEach((points, k) => {
    if (!context) return;
    context.fillStyle = colorOf(k);
    for (const [x, y] of points)
      context.fillRect((x + reach) * px - DOT / 2, (reach - y) * px - DOT / 2, DOT, DOT);
  });
  return canvas;
}
