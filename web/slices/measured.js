// Where a surveyed point was measured, and in which directions. No DOM, no network.

/** @typedef {{p: number[], along: number[][]}} Measurement a place; directions it holds in */

const ALONG = 0.02; // of a unit vector outside of known directions: shorter is none of its own

/**
 * @param {number[]} a
 * @param {number[]} b
 */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/**
 * @param {number[]} a
 * @param {number[]} b
 */
const plus = (a, b, times = 1) => a.map((x, k) => x + times * b[k]);

/**
 * The part of a vector in the directions of orthonormal rows.
 * @param {number[][]} rows
 * @param {number[]} v
 */
const within = (rows, v) => rows.reduce((sum, row) => plus(sum, row, dot(row, v)), [0, 0, 0]);

/**
 * Orthonormal rows that span `known` (orthonormal) and further directions.
 * @param {number[][]} known
 * @param {number[][]} directions
 */
function extended(known, directions) {
  const rows = [...known];
  for (const one of directions) {
    const unit = one.map((x) => x / Math.hypot(...one));
    const rest = plus(unit, within(rows, unit), -1);
    const length = Math.hypot(...rest);
    if (rows.length < 3 && length > ALONG) rows.push(rest.map((x) => x / length));
  }
  return rows;
}

/** All directions are measured. @type {Array<[number, number, number]>} */
export const AXES = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];

/**
 * A measurement {p, along} and an earlier one of the same point: the new one counts in its own
 * directions, the earlier one in those that the new one leaves open.
 * @param {Measurement | null} earlier
 * @param {Measurement} later
 */
export function combined(earlier, later) {
  const own = extended([], later.along);
  if (!earlier) return { p: later.p, along: own };
  const all = extended(own, earlier.along);
  const open = all.slice(own.length);
  return { p: plus(later.p, within(open, plus(earlier.p, later.p, -1))), along: all };
}
