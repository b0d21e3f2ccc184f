// Rows of the residuals and of the limits at control and check points. No network.

import { make } from "../shared/dom.js";

const UNKNOWN = "–"; // not measured
const COLUMNS = 8;

const cm = (m) => (m === null ? UNKNOWN : (m * 100).toFixed(1));
const cell = (text, className = "") => make("td", { className: `number ${className}` }, text);

/** Error ellipse and height: long axis x short axis at the azimuth of the long one, height. */
const stated = (one) =>
  one
    ? `${cm(one.major_m)} × ${cm(one.minor_m)} at ${one.azimuth_deg.toFixed(0)}°, ${cm(one.up_m)}`
    : UNKNOWN;

function sigmas({ sigmas: found, outlier }) {
  if (found === null) return cell(UNKNOWN);
  return outlier ? cell(`⚠ ${found.toFixed(1)}`, "bad") : cell(found.toFixed(1));
}

/** The cells of one point; empty if it was not measured in this map. */
export function residualCells(residual, earlier) {
  if (earlier)
    return [make("td", { colSpan: COLUMNS, className: "quiet" }, "found in an earlier map")];
  if (!residual) return Array.from({ length: COLUMNS }, () => cell(""));
  const { east_m, north_m, up_m, d2_m, d3_m } = residual;
  return [
    ...[east_m, north_m, up_m, d2_m, d3_m].map((d) => cell(cm(d))),
    cell(residual.directions === 1 ? cm(residual.across_m) : ""),
    cell(stated(residual.stated)),
    sigmas(residual),
  ];
}

function limitRow(limit) {
  const tone = limit.holds === null ? "" : limit.holds ? "good" : "bad";
  return make(
    "tr",
    {},
    make("th", { scope: "row" }, limit.label),
    make("td", { className: tone }, limit.text),
    cell(String(limit.points)),
    cell(cm(limit.value_m)),
    cell(`≤ ${cm(limit.limit_m)}`),
  );
}

const axes = (figures, key) =>
  figures.axes.map((one) => `${one.axis} ${cm(one[key])} (${one.points})`).join("  ");

/** The limits of one role, with what was measured. */
export function figures(one) {
  const head = [
    `${one.points} ${one.role} point${one.points === 1 ? "" : "s"}`,
    "Result",
    "Points",
    "Measured [cm]",
    "Limit",
  ].map((text, k) => make("th", { scope: "col", className: k > 1 ? "number" : "" }, text));
  return make(
    "div",
    { className: "figures" },
    make(
      "div",
      { className: "scroll" },
      make(
        "table",
        {},
        make("thead", {}, make("tr", {}, ...head)),
        make("tbody", {}, ...one.requirements.map(limitRow)),
      ),
    ),
    make(
      "p",
      { className: "quiet" },
      `RMSE (points) ${axes(one, "rmse_m")}  3D ${cm(one.rmse_3d_m)} cm`,
    ),
    make("p", { className: "quiet" }, `Mean ${axes(one, "mean_m")} cm`),
  );
}
