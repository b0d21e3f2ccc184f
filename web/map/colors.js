// Colors of points and of their legend. No DOM, no network.

import { decimal } from "../shared/texts.js";

/** @import {ColorBy} from "./state.js" */

const VIRIDIS = [
  [68, 1, 84],
  [71, 24, 106],
  [72, 44, 122],
  [66, 64, 134],
  [59, 82, 139],
  [51, 99, 141],
  [44, 114, 142],
  [38, 130, 142],
  [33, 145, 140],
  [31, 160, 136],
  [40, 174, 128],
  [63, 188, 115],
  [94, 201, 98],
  [132, 212, 75],
  [173, 220, 48],
  [216, 226, 25],
  [253, 231, 37],
];
const TURBO = [
  [48, 18, 59],
  [64, 64, 162],
  [70, 107, 227],
  [66, 147, 254],
  [40, 187, 236],
  [24, 220, 197],
  [49, 242, 153],
  [107, 254, 100],
  [162, 252, 60],
  [204, 237, 52],
  [237, 208, 58],
  [253, 173, 53],
  [251, 128, 34],
  [236, 82, 15],
  [210, 49, 5],
  [172, 22, 1],
  [122, 4, 3],
];
const GRAY = Array.from({ length: 17 }, (_, k) => [0, 1, 2].map(() => 40 + (k * 205) / 16));

/** Seventeen colors from the low end to the high end. */
export const rampOf = (/** @type {ColorBy} */ color) =>
  color === "height" || color === "time"
    ? TURBO
    : color === "intensity" || color === "normalized"
      ? GRAY
      : VIRIDIS;

/** @type {Record<number, number[]>} */
const CLASS_COLORS = {
  0: [160, 160, 165],
  1: [214, 178, 94],
  2: [150, 116, 84],
  3: [150, 205, 120],
  4: [90, 175, 90],
  5: [40, 130, 70],
  6: [172, 190, 212],
  7: [230, 90, 90],
  18: [230, 60, 140],
  64: [255, 120, 40],
  65: [180, 90, 220],
  66: [80, 200, 220],
};
/** The color of a class. */
export const classColor = (/** @type {number} */ code) => CLASS_COLORS[code] ?? [200, 200, 200];

/** A color as CSS says it. */
export const css = (/** @type {number[]} */ rgb) => `rgb(${rgb.map(Math.round).join(" ")})`;

/** Ends of the colors as the captions of a legend. */
export function endText(/** @type {number} */ value, /** @type {string} */ unit) {
  if (unit === "m" && Math.abs(value) < 0.1) return `${decimal(1000 * value, 1)} mm`;
  const digits = Math.abs(value) >= 100 ? 0 : unit === "m" ? 2 : 1;
  return `${decimal(value, digits)}${unit ? ` ${unit}` : ""}`;
}
