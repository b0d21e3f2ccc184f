// The table of slices against a reference (V Table 3.2) with signs, and its histogram. No network.

import { make } from "../shared/dom.js";
import { count } from "../shared/format.js";

export const METHODS = { plane: "to the reference's surface", point: "to its nearest point (V)" };
const UNKNOWN = "–";
const SVG = "http://www.w3.org/2000/svg";
const HEIGHT = 100;

const cell = (text) => make("td", { className: "number" }, text);
const figure = (x, digits = 2) =>
  cell(x === null ? UNKNOWN : (x * 100).toFixed(digits).replace(/^-(0\.?0*)$/, "$1"));

const HEAD = [
  ...["Slice", "Mean [cm]", "< 2 cm [%]", "< 5 cm [%]", "Signed mean [cm]", "σ [cm]"],
  ...["Shift x", "Shift y", "Shift z", "Points", "> 50 cm"],
];

const row = (name, one) =>
  make(
    "tr",
    {},
    make("th", { scope: "row" }, name),
    figure(one.mean_m),
    figure(one.ratio_within_2cm, 1),
    figure(one.ratio_within_5cm, 1),
    figure(one.signed.mean_m),
    figure(one.signed.sd_m),
    ...one.signed.shift_m.map((x) => figure(x)),
    cell(count(one.points)),
    cell(count(one.outliers)),
  );

/** The table of a comparison, its histogram, and whether the reference fits at all. */
export function comparison(found, csvUrl) {
  const head = HEAD.map((text, k) =>
    make("th", { scope: "col", className: k ? "number" : "" }, text),
  );
  const plain = make(
    "tr",
    {},
    make("th", { scope: "row" }, "Mean of the slices"),
    figure(found.plain_mean_m),
  );
  const rows = [
    ...found.slices.map((one) => row(one.name, one)),
    row("Mean of all points", found.point_weighted),
    plain,
  ];
  const tone = found.fit.fits === null ? "" : found.fit.fits ? "good" : "bad";
  return [
    make("p", { className: `verdict ${tone}` }, found.fit.text),
    found.fit.fits === false
      ? make("p", { className: "bad" }, "The figures are not those of one and the same place.")
      : null,
    make(
      "div",
      { className: "scroll" },
      make(
        "table",
        { className: found.fit.fits === false ? "unfit" : "" },
        make("thead", {}, make("tr", {}, ...head)),
        make("tbody", {}, ...rows),
      ),
    ),
    make(
      "p",
      { className: "quiet" },
      `Against ${found.reference}, distances ${METHODS[found.method]}, alignment: `,
      `${found.alignment}. ${found.notes.join(" ")} Signed: across the `,
      "surfaces, + = the map lies in front of the reference, on the side it was seen from. Walls ",
      "that face each other cancel there; the shift [cm] is the common translation of the map.",
    ),
    histogram(found),
    make("a", { className: "button", href: csvUrl, download: "" }, "Download CSV"),
  ].filter(Boolean);
}

/** Bars [x, y, width, height] in a box of width 1 a class and height 100, and the most points. */
export function bars(classes) {
  const most = Math.max(...classes);
  return classes.map((n, k) => {
    const height = most ? (HEIGHT * n) / most : 0;
    return [k, HEIGHT - height, 1, height];
  });
}

function histogram({ histogram: classes, histogram_end_m: end, histogram_step_m: step }) {
  if (!classes.some(Boolean)) return null;
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", `0 0 ${classes.length} ${HEIGHT}`);
  svg.setAttribute("preserveAspectRatio", "none");
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", "Histogram of the signed distances");
  const add = (className, [x, y, width, height]) => {
    const rect = document.createElementNS(SVG, "rect");
    const box = { class: className, x, y, width, height };
    for (const [key, value] of Object.entries(box)) rect.setAttribute(key, String(value));
    svg.append(rect);
  };
  for (const bar of bars(classes)) add("bar", bar);
  add("zero", [classes.length / 2 - 0.15, 0, 0.3, HEIGHT]);
  const cm = (end * 100).toFixed(0);
  return make(
    "figure",
    { className: "histogram" },
    make("figcaption", {}, `Points by signed distance, classes of ${(step * 1000).toFixed(0)} mm`),
    svg,
    make(
      "p",
      { className: "scale" },
      ...[`≤ −${cm} cm`, "0", `≥ ${cm} cm`].map((text) => make("span", {}, text)),
    ),
  );
}
