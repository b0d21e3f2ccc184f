// The marked stretch of the walk, as that of a finding. No DOM, no network.

/**
 * @import {SliceImageView} from "../shared/http_types"
 * @import {Mark} from "./marks.js"
 */

/** A part of the walk is marked in a slice that is at most so far away [m]. */
export const NEAR_M = 2.5;

/** Both ends of a stretch, "x,y,z,x,y,z" [m]; none if it is another text. */
export function endsOf(/** @type {string} */ mark) {
  const numbers = mark.split(",").map(Number);
  return numbers.length === 6 && numbers.every(Number.isFinite)
    ? [numbers.slice(0, 3), numbers.slice(3)]
    : [];
}

/** The times of a stretch, "from,to" [s]; null if it is another text. */
export function timesOf(/** @type {string} */ span) {
  const [from, to, ...more] = span.split(",").map((text) => (text === "" ? NaN : Number(text)));
  const known = from !== undefined && to !== undefined && Number.isFinite(from + to);
  return known && more.length === 0 ? /** @type {[number, number]} */ ([from, to]) : null;
}

/**
 * Marks of positions of the walk [m] in a slice: those near it, as lines with their ends.
 * @param {number[][]} positions
 * @param {Pick<SliceImageView, "origin_m" | "u" | "v">} plane
 * @returns {Mark[]}
 */
export function stretchMarks(positions, { origin_m, u, v }) {
  /** @type {number[][][]} */
  const runs = [];
  let run = /** @type {number[][] | null} */ (null);
  for (const p of positions) {
    const from = p.map((x, k) => x - (origin_m[k] ?? 0));
    if (Math.abs(dot(from, cross(u, v))) > NEAR_M) {
      run = null;
      continue;
    }
    if (!run) runs.push((run = []));
    run.push([dot(from, u), dot(from, v)]);
  }
  return runs.map((points) => ({
    points,
    dots: [...points.slice(0, 1), ...points.slice(-1)],
    tone: "--bad",
  }));
}

/**
 * @param {number[]} a
 * @param {number[]} b
 */
const dot = (a, b) => a.reduce((sum, x, k) => sum + x * (b[k] ?? 0), 0);

/**
 * @param {number[]} a
 * @param {number[]} b
 */
const cross = ([ax = 0, ay = 0, az = 0], [bx = 0, by = 0, bz = 0]) => [
  ay * bz - az * by,
  az * bx - ax * bz,
  ax * by - ay * bx,
];
