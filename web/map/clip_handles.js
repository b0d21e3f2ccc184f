// Handles of the clip box and of the section: where they are, and what a drag of one leads to.
// No DOM, no network.

import { add, axesOf, dot, eyeOf, lengthOf, minus } from "./camera.js";
import { acrossOf, axesOfBox } from "./clip.js";

/**
 * @import {Camera, Ray, Xyz} from "./camera.js"
 * @import {Clip} from "./clip.js"
 * @typedef {object} Handle
 * @property {string} key "+x", "-x" … of the box, "section"
 * @property {Xyz} p [m]
 * @property {Xyz} axis unit vector along which it moves
 * @property {number} m what it changes: size of the box, distance of the section's plane from 0
 */

const THINNEST_M = 0.05;
const STEEPEST = 0.96; // cosine: an axis that runs so much into the image cannot be dragged

/**
 * @param {Clip} clip
 * @param {[number, number]} heights that are shown [m]
 * @returns {Handle[]}
 */
export function handlesOf({ box, section }, heights) {
  const handles = [];
  if (box)
    for (const [k, axis] of axesOfBox(box.yaw).entries())
      for (const side of [1, -1]) {
        const out = add([0, 0, 0], axis, side);
        const p = add(box.center, out, box.size[k] / 2);
        handles.push({ key: `${side > 0 ? "+" : "-"}${"xyz"[k]}`, p, axis: out, m: box.size[k] });
      }
  if (section) {
    const { a, b } = section;
    const axis = acrossOf(section);
    const p = /** @type {Xyz} */ ([
      (a[0] + b[0]) / 2,
      (a[1] + b[1]) / 2,
      (heights[0] + heights[1]) / 2,
    ]);
    handles.push({ key: "section", p, axis, m: dot(p, axis) });
  }
  return handles;
}

/**
 * The clip after a handle was moved along its axis.
 * @param {Clip} clip
 * @param {Pick<Handle, "key" | "axis">} handle
 * @param {number} by [m]
 * @returns {Clip}
 */
export function movedHandle(clip, { key, axis }, by) {
  const { box, section } = clip;
  if (key === "section" && section) {
    const [a, b] = [section.a, section.b].map(
      (end) => /** @type {[number, number]} */ ([end[0] + by * axis[0], end[1] + by * axis[1]]),
    );
    return { ...clip, section: { ...section, a, b } };
  }
  if (!box) return clip;
  const k = "xyz".indexOf(key[1]);
  const size = /** @type {Xyz} */ ([...box.size]);
  size[k] = Math.max(THINNEST_M, size[k] + by);
  const center = add(box.center, axis, (size[k] - box.size[k]) / 2);
  return { ...clip, box: { ...box, size, center } };
}

/** Whether a handle moves across the image so far that a pointer can say how far. */
export function isDraggable(/** @type {Camera} */ camera, /** @type {Handle} */ { p, axis }) {
  const to = camera.parallel ? axesOf(camera).ahead : minus(p, eyeOf(camera));
  return Math.abs(dot(axis, to)) < STEEPEST * lengthOf(to);
}

/**
 * How far along its axis a handle is nearest to a ray [m].
 * @param {Handle} handle
 * @param {Ray} ray
 */
export function alongAxis({ p, axis }, { origin, direction }) {
  const from = minus(p, origin);
  const slope = dot(axis, direction);
  const across = Math.max(1 - slope * slope, 1e-3);
  return (slope * dot(from, direction) - dot(from, axis)) / across;
}
