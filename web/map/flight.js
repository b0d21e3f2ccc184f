// Along the walk: where one is at a time, and which way one looks. No DOM, no network.

import { add, dot, lengthOf, minus } from "./camera.js";

/**
 * @import {Camera, Xyz} from "./camera.js"
 * @typedef {{t_s: number[], positions_m: number[][]}} Walk
 */

const AHEAD_S = 2.5; // one looks to where the walk will be after this time
const TARGET_M = 2; // of a standing camera

/** The position at a time [m]. */
export function positionAt(/** @type {Walk} */ { t_s, positions_m }, /** @type {number} */ time) {
  let [low, high] = [0, t_s.length - 1];
  if (time <= t_s[0]) return positions_m[0];
  if (time >= t_s[high]) return positions_m[high];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (t_s[middle] <= time) low = middle;
    else high = middle;
  }
  const part = (time - t_s[low]) / (t_s[high] - t_s[low] || 1);
  return add(positions_m[low], minus(positions_m[high], positions_m[low]), part);
}

/**
 * The camera of who walks, looking where they go; turns are smooth.
 * @param {Walk} walk
 * @param {number} time
 * @param {Camera} before
 * @returns {Camera}
 */
export function walking(walk, time, before) {
  const here = positionAt(walk, time);
  const ahead = minus(positionAt(walk, time + AHEAD_S), here);
  const level = Math.hypot(ahead[0], ahead[1]);
  const goal = level > 0.3 ? Math.atan2(ahead[0], ahead[1]) : before.yaw;
  const turn = Math.atan2(Math.sin(goal - before.yaw), Math.cos(goal - before.yaw));
  return standingAt(here, before.yaw + 0.15 * turn, -0.08);
}

/**
 * A camera whose eye is at a place.
 * @param {number[]} eye
 * @param {number} yaw
 * @param {number} pitch
 * @returns {Camera}
 */
export function standingAt(eye, yaw, pitch) {
  const level = Math.cos(pitch);
  const direction = [Math.sin(yaw) * level, Math.cos(yaw) * level, Math.sin(pitch)];
  return {
    target: add(eye, direction, TARGET_M),
    yaw,
    pitch,
    distance: TARGET_M,
    parallel: false,
  };
}

/**
 * Time of the position of the walk that is nearest to a ray, and its distance from it [s, m].
 * @param {Walk} walk
 * @param {{origin: number[], direction: number[]}} ray
 */
export function nearestTo({ t_s, positions_m }, { origin, direction }) {
  const best = { time: 0, away: Infinity, position: /** @type {number[]} */ ([0, 0, 0]) };
  positions_m.forEach((p, k) => {
    const to = minus(p, origin);
    const depth = dot(to, direction);
    if (depth <= 0) return;
    const away = lengthOf(minus(to, add([0, 0, 0], direction, depth))) / Math.max(depth, 0.1);
    if (away < best.away) Object.assign(best, { time: t_s[k], away, position: p });
  });
  return best;
}
