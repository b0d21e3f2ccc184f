// Slices through a walk before and after a calibration, side by side.

import { make } from "../shared/dom.js";

const COLORS = ["#2b7de9", "#e07b1a", "#2f9e5f", "#c0458f"]; // readable on light and on dark
const SIZE = 480; // pixels of a drawing
const DOT = 1.6;

/** The two drawings with their legend. */
export function calibrationSlices({ lidars, thickness_m: thickness }) {
  const reach = Math.max(
    1,
    ...lidars.flatMap(({ before, after }) => [...before, ...after].flat().map(Math.abs)),
  );
  const names = lidars.map((one) => one.name).join(" and ");
  const name = (text) => `Slice ${Math.round(100 * thickness)} cm thick, ${text}, ${names}`;
  return make(
    "div",
    { className: "calibration-slices" },
    ...[
      ["before", "Rig file"],
      ["after", "Calibrated"],
    ].map(([key, text]) =>
      make(
        "figure",
        {},
        drawing(
          lidars.map((one) => one[key]),
          reach,
          name(text.toLowerCase()),
        ),
        make("figcaption", {}, text),
      ),
    ),
    make(
      "p",
      { className: "quiet" },
      ...lidars.flatMap((one, k) => [legend(k), ` ${one.name} `]),
      `· a slice ${Math.round(100 * thickness)} cm thick, ${(2 * reach).toFixed(0)} m wide`,
    ),
  );
}

const legend = (k) => {
  const dot = make("i");
  dot.style.background = COLORS[k % COLORS.length];
  return dot;
};

function drawing(clouds, reach, label) {
  const canvas = make("canvas", { width: SIZE, height: SIZE, role: "img", ariaLabel: label });
  const context = canvas.getContext("2d");
  const px = SIZE / (2 * reach);
  clouds.forEach((points, k) => {
    context.fillStyle = COLORS[k % COLORS.length];
    for (const [x, y] of points)
      context.fillRect((x + reach) * px - DOT / 2, (reach - y) * px - DOT / 2, DOT, DOT);
  });
  return canvas;
}
