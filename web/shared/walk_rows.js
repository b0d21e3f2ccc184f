// Where stretches of a walk lie on its time axis. No DOM, no network.

import { roundStep } from "./scale_bar.js";

/**
 * @import {MapFinding} from "./verdict.js"
 * @typedef {object} Bar a stretch on the axis, in percent of its length
 * @property {MapFinding} finding
 * @property {number} left
 * @property {number} width
 */

const LEAST_WIDTH = 0.8; // so that a moment is seen
const LEAST_GAP = 0.4;
const MOST_TICKS = 6;

/**
 * The stretches of findings in rows, in each of which none overlaps another.
 * @param {MapFinding[]} findings
 * @param {number} duration_s of the walk
 */
export function rowsOf(findings, duration_s) {
  /** @type {Bar[][]} */
  const rows = [];
  const bars = findings.flatMap((finding) => {
    if (!finding.span_s) return [];
    const [start, end] = finding.span_s.map((s) => (100 * Math.min(s, duration_s)) / duration_s);
    const width = Math.max((end ?? 0) - (start ?? 0), LEAST_WIDTH);
    return [{ finding, left: Math.min(start ?? 0, 100 - width), width }];
  });
  for (const bar of bars.sort((a, b) => a.left - b.left)) {
    const free = rows.find((row) => {
      const last = row.at(-1);
      return !last || last.left + last.width + LEAST_GAP <= bar.left;
    });
    if (free) free.push(bar);
    else rows.push([bar]);
  }
  return rows;
}

/** Round times along a walk [s], from its start. */
export function ticksOf(/** @type {number} */ duration_s) {
  const step = roundStep(duration_s / MOST_TICKS);
  return Array.from({ length: Math.floor(duration_s / step) + 1 }, (_, k) => k * step);
}
