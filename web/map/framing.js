// What the camera has to show: the part of the map that the clip leaves. No DOM, no network.

import { cornersOf, fitted } from "./camera.js";
import { planesOf, yawOfSection } from "./clip.js";

/**
 * @import {MapIndex} from "../shared/http_types"
 * @import {Free, Screen, View} from "./camera.js"
 * @import {Clip} from "./clip.js"
 */

/**
 * The part of the image that nothing covers: at least half of its height.
 * @param {Screen} screen
 * @param {{above: number, below: number, beside: number}} covered [px]
 * @returns {Free}
 */
export function freeOf({ width, height }, { above, below, beside }) {
  const part = Math.min(1, height / 2 / Math.max(above + below, 1));
  const [left, right] = [width / 2, width / 2 - beside];
  return { left, right, up: height / 2 - part * above, down: height / 2 - part * below };
}

/**
 * Corners of all tiles of the map, of each the part without stray points that the clip leaves.
 * @param {Pick<MapIndex, "tiles" | "low_m" | "high_m">} index
 * @param {Clip} clip
 * @returns {number[][]}
 */
export function cornersShown({ tiles, low_m, high_m }, clip) {
  const planes = planesOf(clip);
  const found = tiles.flatMap((tile) =>
    cornersLeft(
      tile.low_m.map((x, k) => Math.max(x, low_m[k])),
      tile.high_m.map((x, k) => Math.min(x, high_m[k])),
      planes,
    ),
  );
  return found.length ? found : cornersOf(low_m, high_m);
}

/**
 * What planes leave of a box. Each of them is level or vertical.
 * @param {number[]} low
 * @param {number[]} high
 * @param {number[][]} planes
 */
function cornersLeft([west, south, bottom], [east, north, top], planes) {
  if (west > east || south > north) return [];
  let ground = [
    [west, south],
    [east, south],
    [east, north],
    [west, north],
  ];
  for (const [x, y, z, offset] of planes) {
    if (z > 0) bottom = Math.max(bottom, -offset);
    else if (z < 0) top = Math.min(top, offset);
    else ground = cut(ground, [x, y, offset]);
  }
  return bottom > top ? [] : ground.flatMap(([x, y]) => [bottom, top].map((z) => [x, y, z]));
}

/**
 * The part of a convex polygon on one side of a line.
 * @param {number[][]} polygon
 * @param {number[]} line
 */
function cut(polygon, [nx, ny, offset]) {
  const off = (/** @type {number[]} */ [x, y]) => nx * x + ny * y + offset;
  return polygon.flatMap((p, k) => {
    const next = polygon[(k + 1) % polygon.length];
    const [from, to] = [off(p), off(next)];
    const part = from / (from - to);
    const crossing = from < 0 !== to < 0 ? [p.map((x, axis) => x + part * (next[axis] - x))] : [];
    return from < 0 ? crossing : [p, ...crossing];
  });
}

/**
 * Straight at a section, from end to end.
 * @param {NonNullable<Clip["section"]>} section
 * @param {[number, number]} heights
 * @param {View} view
 */
export function frontOf(section, heights, view) {
  const look = { yaw: yawOfSection(section), pitch: 0, parallel: true };
  const corners = [section.a, section.b].flatMap((p) => heights.map((z) => [...p, z]));
  return fitted(look, view, corners);
}
