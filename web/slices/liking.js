// All things like one: a click on a slice picks it; boxes are drawn where the slice cuts them.

import { axesOf } from "./state.js";

/**
 * @import {Box} from "../shared/alike.js"
 * @import {Mark} from "./marks.js"
 * @import {SliceState} from "./state.js"
 * @typedef {object} Liking
 * @property {boolean} on whether a click picks a thing
 * @property {number[] | null} place where one was picked, in the map [m]
 * @property {Box[]} boxes of the things that are meant
 */

const EDGES = [0, 1, 2].flatMap((axis) =>
  [0, 1, 2, 3, 4, 5, 6, 7].filter((k) => !((k >> axis) & 1)).map((k) => [k, k | (1 << axis)]),
);

export const noLiking = () => /** @type {Liking} */ ({ on: false, place: null, boxes: [] });

/**
 * Outlines of the boxes that a slice cuts, on it.
 * @param {SliceState} state
 * @param {Box[]} boxes
 * @returns {Mark[]}
 */
export function boxMarks(state, boxes) {
  const { origin_m, u, v } = axesOf(state);
  const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const along = (/** @type {number[]} */ p, /** @type {number[]} */ axis) =>
    axis.reduce((sum, a, k) => sum + a * (p[k] - origin_m[k]), 0);
  return boxes.flatMap((box) => {
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((which) =>
      [0, 1, 2].map((k) => ((which >> k) & 1 ? box.high[k] : box.low[k])),
    );
    const away = corners.map((p) => along(p, n));
    const half = state.t / 2;
    if (Math.min(...away) > half || Math.max(...away) < -half) return [];
    const level = Math.min(half, Math.max(-half, 0, Math.min(...away)), Math.max(...away));
    const cut = EDGES.flatMap(([a, b]) => crossing(corners[a], corners[b], along, n, level)).map(
      (p) => [along(p, u), along(p, v)],
    );
    const outline = around(cut.length >= 3 ? cut : corners.map((p) => [along(p, u), along(p, v)]));
    return [{ points: [...outline, outline[0]], dots: [], tone: "--mark" }];
  });
}

/**
 * Where an edge crosses a plane.
 * @param {number[]} a
 * @param {number[]} b
 * @param {(p: number[], axis: number[]) => number} along
 * @param {number[]} n
 * @param {number} level
 */
function crossing(a, b, along, n, level) {
  const [from, to] = [along(a, n) - level, along(b, n) - level];
  if (from === to || from * to > 0) return [];
  return [a.map((x, k) => x + ((b[k] - x) * from) / (from - to))];
}

/** Corners of a convex polygon in order around their middle. */
function around(/** @type {number[][]} */ points) {
  const middle = [0, 1].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length);
  const angle = (/** @type {number[]} */ p) => Math.atan2(p[1] - middle[1], p[0] - middle[0]);
  return points.toSorted((a, b) => angle(a) - angle(b));
}

/**
 * Changes what is picked on a page, and returns it.
 * @param {{like: Liking}} page
 * @param {(on: boolean) => void} changed
 */
export const likingOf =
  (page, changed) =>
  (/** @type {Partial<Liking> | undefined} */ next = undefined) => {
    if (!next) return page.like;
    const before = page.like;
    page.like = { ...before, ...next };
    if (JSON.stringify(before) !== JSON.stringify(page.like)) changed(page.like.on);
    return page.like;
  };
