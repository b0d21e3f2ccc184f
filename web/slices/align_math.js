// Frames of points and poses between a map and a reference. No DOM, no network.

import { rotationOf, turn } from "../review/math.js";

/**
 * @import {AlignPoints} from "../shared/http_types"
 * @typedef {[number, number, number]} Xyz
 */

/** Points x y z of base64 float32, in meters. */
export function unpacked(/** @type {string} */ base64) {
  const bytes = Uint8Array.from(atob(base64), (one) => one.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

/**
 * @param {number[]} a
 * @param {number[]} b
 */
const plus = (a, b) => /** @type {Xyz} */ (a.map((x, k) => x + b[k]));

/**
 * Picked points in the frames of map and reference; those of the view are about a middle.
 * @param {{p_i: number[][], p_j: number[][]}} picked
 * @param {Pick<AlignPoints, "middle_map" | "middle_reference">} middles
 */
export const inFrames = ({ p_i, p_j }, { middle_map, middle_reference }) => ({
  p_map: p_i.map((p) => plus(p, middle_map)),
  p_reference: p_j.map((p) => plus(p, middle_reference)),
});

/**
 * The pose of the reference's frame in the map of a pose of their middles.
 * @param {number[]} pose
 * @param {Pick<AlignPoints, "middle_map" | "middle_reference">} middles
 */
export function poseInMap(pose, { middle_map, middle_reference }) {
  const back = turn(rotationOf(pose.slice(3)), middle_reference);
  const t = middle_map.map((x, k) => x + pose[k] - back[k]);
  return /** @type {AlignPoints["pose"]} */ ([...t, ...pose.slice(3)]);
}
