// Rows of the residuals and of the limits at control and check points. No network.

import { decimal, t } from "../shared/texts.js";
import { html, nothing } from "../shared/dom.js";

/**
 * @import {
 *   ErrorEllipse, Requirement, Residual, ResidualStatistics, TriedPoint
 * } from "../shared/http_types"
 */

const UNKNOWN = "–"; // not measured
/** Heads of the table of points; what is stated of a point stands below its row. */
export const HEADS = [t("point"), t("role"), "dE", "dN", "dU", "2D", "3D", t("across")];
const COLUMNS = HEADS.length - 2;

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

/** What map and survey state of a point, and the residual in these deviations. */
export function statedText(/** @type {Residual | undefined} */ residual) {
  if (!residual?.stated && !residual?.survey) return nothing;
  const { stated: map, survey, sigmas, outlier } = residual;
  const parts = [t("stated", { ellipse: stated(map) })];
  if (survey) parts.push(t("of-survey", { ellipse: stated(survey) }));
  const ratio = sigmas === null ? "" : t("residual-sigma", { value: decimal(sigmas, 1) });
  if (ratio) parts.push("");
  return html`<span class="quiet">${parts.join(" · ")}</span> ${
      ratio
        ? html`<span class=${outlier ? "bad" : "quiet"}>${outlier ? "⚠ " : ""}${ratio}</span>`
        : nothing
    }`;
}

/**
 * The cells of one point; empty if it was not measured in this map.
 * @param {Residual | undefined} residual
 * @param {string} unused why what was measured does not count; empty = it does
 */
export function residualCells(residual, unused) {
  if (unused) return [html`<td colspan=${COLUMNS} class="quiet">${unused}</td>`];
  if (!residual) return Array.from({ length: COLUMNS }, () => cell(""));
  const { east_m, north_m, up_m, d2_m, d3_m } = residual;
  return [
    ...[east_m, north_m, up_m, d2_m, d3_m].map((d) => cell(cm(d))),
    cell(residual.directions === 1 ? cm(residual.across_m) : ""),
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

/** Points after the rigid fit of a trial [cm]. */
export const triedTable = (/** @type {TriedPoint[]} */ points) =>
  html`<div class="scroll points">
    <table>
      <thead>
        <tr>
          ${[t("point"), t("role"), "dE", "dN", "dU", t("w-limit"), ""].map(
            (text, k) => html`<th scope="col" class=${k > 1 ? "number" : ""}>${text}</th>`,
          )}
        </tr>
      </thead>
      <tbody>
        ${points.map(
          (one) =>
            html`<tr>
              <th scope="row">${one.id}</th>
              <td>${roleText(one.role)}</td>
              ${one.off_m.map((d) => cell(cm(d)))}
              ${cell(
                one.w === null || one.limit === null
                  ? ""
                  : `${decimal(one.w, 1)} (${decimal(one.limit, 1)})`,
              )}
              <td class=${one.w !== null && one.w > (one.limit ?? 0) ? "bad" : "quiet"}>
                ${one.said}
              </td>
            </tr>`,
        )}
      </tbody>
    </table>
  </div>`;
