// The brush: a drag paints what is seen under the pointer, to give it another class.

import { MOST_PLACES } from "../shared/brush_limits.js";
import { t } from "../shared/texts.js";
import { page } from "./page.js";

/**
 * @import {Volume} from "../shared/class_corrections.js"
 * @typedef {number[]} Pixel
 * @typedef {(at: Pixel) => number[] | null} Under the point of the map under a pixel
 */

const CLOSE = 0.3; // nearer places, in radii, add nothing
const FAR = 1.2; // between places farther apart, in radii, others are looked for
const FINEST_PX = 4;

/** Where the pointer was last, and what it met there. */
/** @type {{at: Pixel | null, p: number[] | null}} */
const pointer = { at: null, p: null };

const apart = (/** @type {number[]} */ a, /** @type {number[]} */ b) =>
  Math.hypot(...a.map((x, k) => x - b[k]));

const placesOf = (/** @type {number[][][]} */ strokes) =>
  strokes.reduce((sum, stroke) => sum + stroke.length, 0);

/**
 * Points of the map under a line of pixels, so close that the brush leaves no gap; where the line
 * goes from one surface to another, there is none between.
 * @param {{at: Pixel, p: number[] | null}} from
 * @param {{at: Pixel, p: number[] | null}} to
 * @param {{under: Under, radius: number}} how
 * @returns {number[][]} those between both ends
 */
export function between(from, to, { under, radius }) {
  const isClose = from.p && to.p && apart(from.p, to.p) <= FAR * radius;
  if (isClose || apart(from.at, to.at) <= FINEST_PX) return [];
  const at = from.at.map((x, k) => (x + to.at[k]) / 2);
  const middle = { at, p: under(at) };
  return [
    ...between(from, middle, { under, radius }),
    ...(middle.p ? [middle.p] : []),
    ...between(middle, to, { under, radius }),
  ];
}

/**
 * Paints along the pointer.
 * @param {Pixel} from where it went down
 * @param {Pixel} to where it is
 * @param {{under: Under, draw: () => void, done: boolean}} stage
 */
export function paint(from, to, { under, draw, done }) {
  const { brush } = page;
  if (!pointer.at) {
    Object.assign(pointer, { at: from, p: under(from) });
    brush.strokes = [...brush.strokes, pointer.p ? [pointer.p] : []];
  }
  const next = { at: to, p: under(to) };
  const last = { at: /** @type {Pixel} */ (pointer.at), p: pointer.p };
  const met = between(last, next, { under, radius: brush.radius });
  if (next.p) met.push(next.p);
  const stroke = [...(brush.strokes.at(-1) ?? [])];
  for (const p of met) {
    const before = stroke.at(-1);
    if (!before || apart(before, p) > CLOSE * brush.radius) stroke.push(p);
  }
  const strokes = [...brush.strokes.slice(0, -1), stroke];
  if (placesOf(strokes) <= MOST_PLACES) brush.strokes = strokes;
  else page.reading = t("brush-full");
  Object.assign(pointer, done ? { at: null, p: null } : next);
  if (done) brush.strokes = brush.strokes.filter(({ length }) => length > 0);
  draw();
}

/** Undoes a stroke that the system, or a second finger, interrupted: two fingers move. */
export function liftBrush() {
  if (pointer.at) page.brush.strokes = page.brush.strokes.slice(0, -1);
  Object.assign(pointer, { at: null, p: null });
}

const rounded = (/** @type {number[]} */ [x, y, z]) =>
  /** @type {[number, number, number]} */ ([x, y, z].map((value) => Number(value.toFixed(4))));

/** What was painted, as the server expects it; null = nothing. @returns {Volume | null} */
export function paintedVolume({ strokes, radius } = page.brush) {
  const path_m = strokes.flat().map(rounded);
  return path_m.length ? { shape: "brush", path_m, radius_m: radius } : null;
}
