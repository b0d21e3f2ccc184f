// Rows of the residuals and of the limits at control and check points. No network.

import { decimal, t } from "../shared/texts.js";
import { html } from "../shared/dom.js";

/** @import {ErrorEllipse, Requirement, Residual, ResidualStatistics} from "../shared/http_types" */

const UNKNOWN = "–"; // not measured
const COLUMNS = 8;
/** Heads of the table of points. */
export const HEADS = [
  ...[t("point"), t("role"), "dE", "dN", "dU", "2D", "3D", t("across")],
  ...[t("stated"), t("residual-sigma"), ""],
];

const cm = (/** @type {number | null} */ m) => (m === null ? UNKNOWN : decimal(m * 100, 1));
const cell = (/** @type {string} */ text, className = "") =>
  html`<td class="number ${className}">${text}</td>`;

/** Control or check. */
export const roleText = (/** @type {string} */ role) =>
  t(role === "control" ? "role-control" : "role-check");

/** Error ellipse and height: long axis x short axis at the azimuth of the long one, height. */
const stated = (/** @type {ErrorEllipse | null} */ one) =>
  one
    ? t("ellipse", {
        major: cm(one.major_m),
        minor: cm(one.minor_m),
        azimuth: one.azimuth_deg.toFixed(0),
        up: cm(one.up_m),
      })
    : UNKNOWN;

function sigmas(/** @type {Pick<Residual, "sigmas" | "outlier">} */ { sigmas: found, outlier }) {
  if (found === null) return cell(UNKNOWN);
  return outlier ? cell(`⚠ ${decimal(found, 1)}`, "bad") : cell(decimal(found, 1));
}

/**
 * The cells of one point; empty if it was not measured in this map.
 * @param {Residual | undefined} residual
 * @param {boolean} earlier
 */
export function residualCells(residual, earlier) {
  if (earlier) return [html`<td colspan=${COLUMNS} class="quiet">${t("found-earlier")}</td>`];
  if (!residual) return Array.from({ length: COLUMNS }, () => cell(""));
  const { east_m, north_m, up_m, d2_m, d3_m } = residual;
  return [
    ...[east_m, north_m, up_m, d2_m, d3_m].map((d) => cell(cm(d))),
    cell(residual.directions === 1 ? cm(residual.across_m) : ""),
    cell(
      residual.survey
        ? `${stated(residual.stated)} · ${t("of-survey", { ellipse: stated(residual.survey) })}`
        : stated(residual.stated),
    ),
    sigmas(residual),
  ];
}

function limitRow(/** @type {Requirement} */ limit) {
  const tone = limit.holds === null ? "" : limit.holds ? "good" : "bad";
  return html`<tr>
    <th scope="row">${limit.label}</th>
    <td class=${tone}>${limit.text}</td>
    ${cell(String(limit.points))}${cell(cm(limit.value_m))}${cell(`≤ ${cm(limit.limit_m)}`)}
  </tr>`;
}

/**
 * @param {ResidualStatistics} figures
 * @param {"rmse_m" | "mean_m"} key
 */
const axes = (figures, key) =>
  figures.axes.map((one) => `${one.axis} ${cm(one[key])} (${one.points})`).join("  ");

/** The limits of one role, with what was measured. */
export function figures(/** @type {ResidualStatistics} */ one) {
  const head = [
    t("points-of-role", { points: one.points, role: roleText(one.role) }),
    t("result"),
    t("points"),
    t("measured-cm"),
    t("limit"),
  ].map((text, k) => html`<th scope="col" class=${k > 1 ? "number" : ""}>${text}</th>`);
  return html`<div class="figures">
    <div class="scroll">
      <table>
        <thead>
          <tr>
            ${head}
          </tr>
        </thead>
        <tbody>
          ${one.requirements.map(limitRow)}
        </tbody>
      </table>
    </div>
    <p class="quiet">${t("rmse", { axes: axes(one, "rmse_m"), all: cm(one.rmse_3d_m) })}</p>
    <p class="quiet">${t("mean-axes", { axes: axes(one, "mean_m") })}</p>
  </div>`;
}
