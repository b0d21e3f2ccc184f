// The brush on a slice: a drag paints its points, as deep as the slice, to get another class.

import { MOST_PLACES } from "../shared/brush_limits.js";
import { axesOf, normalOf } from "./state.js";

/**
 * @import {Volume} from "../shared/class_corrections.js"
 * @import {Mark} from "./marks.js"
 * @import {SliceState} from "./state.js"
 * @typedef {object} Brush
 * @property {boolean} on whether drags paint
 * @property {number} radius [m]
 * @property {Array<Array<[number, number]>>} strokes u, v [m]
 */

const CLOSE = 0.25; // nearer places, in radii, add nothing

export const noBrush = () => /** @type {Brush} */ ({ on: false, radius: 0.1, strokes: [] });

/**
 * A brush that went on; between places of one stroke others, so that it leaves no gap.
 * @param {Brush} brush
 * @param {number[]} from
 * @param {number[]} to
 * @returns {Brush}
 */
export function painted(brush, from, to) {
  const { radius, strokes } = brush;
  const last = strokes.at(-1)?.at(-1);
  const goesOn = last !== undefined && Math.hypot(last[0] - from[0], last[1] - from[1]) <= radius;
  const [stroke, begin] = goesOn ? [strokes.at(-1) ?? [], last] : [[], null];
  const [a, b] = [begin ?? from, to];
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (begin && length < CLOSE * radius) return brush;
  const steps = Math.max(1, Math.ceil(length / radius));
  const more = Array.from({ length: steps }, (_, k) => pairOf(a, b, (k + 1) / steps));
  const next = [...stroke, ...(begin ? [] : [pairOf(a, b, 0)]), ...(length > 0 ? more : [])];
  const all = goesOn ? [...strokes.slice(0, -1), next] : [...strokes, next];
  return all.flat().length > MOST_PLACES ? brush : { ...brush, strokes: all };
}

/**
 * @param {number[]} a
 * @param {number[]} b
 * @param {number} part
 * @returns {[number, number]}
 */
const pairOf = (a, b, part) => [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])];

/**
 * What was painted as the server expects it; null = nothing.
 * @param {SliceState} state
 * @param {Brush} brush
 * @returns {Volume | null}
 */
export function brushVolume(state, { strokes, radius }) {
  const { origin_m: o, u, v } = axesOf(state);
  const path_m = strokes
    .flat()
    .map(
      ([x, y]) =>
        /** @type {[number, number, number]} */ (
          [0, 1, 2].map((k) => Number((o[k] + x * u[k] + y * v[k]).toFixed(6)))
        ),
    );
  if (!path_m.length) return null;
  const [x, y, z] = normalOf(state);
  return { shape: "brush", path_m, radius_m: radius, across: [x, y, z], thick_m: state.t };
}

/** What is drawn of it. @returns {Mark[]} */
export const brushMarks = (/** @type {Brush} */ { strokes, radius }) =>
  strokes.map((points) => ({ points, dots: [], radius }));

/**
 * Changes the brush of a page, and returns it.
 * @param {{brush: Brush}} page
 * @param {Array<{painting: ((from: number[], to: number[]) => void) | null}>} views it paints on
 * @param {(on: boolean) => void} changed
 */
export function brushOf(page, views, changed) {
  return function change(/** @type {Partial<Brush> | undefined} */ next = undefined) {
    const { brush } = page;
    const isIdle = !brush.on && !brush.strokes.length;
    if (!next || (isIdle && !next.on && !next.radius)) return brush;
    page.brush = { ...brush, ...next };
    const paint = (/** @type {number[]} */ from, /** @type {number[]} */ to) => {
      change(painted(page.brush, from, to));
    };
    for (const view of views) view.painting = page.brush.on ? paint : null;
    changed(page.brush.on);
    return page.brush;
  };
}
