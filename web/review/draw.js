// Drawing the pair view: points of two places, scale bar, handle, picked points. No events.

import { BOTH, ONLY_FIRST, ONLY_SECOND, difference } from "./difference.js";
import { apply, rotationOf, times, turn } from "./math.js";

/**
 * @import {Camera} from "./math.js"
 * @import {Picking} from "./picking.js"
 * @typedef {{i: Float32Array, j: Float32Array}} PairPoints x y z of both places [m]
 * @typedef {{i: number[], j: number[]}} PairPoses
 * @typedef {{upright: number[], camera: Camera, slab: number[]}} Projection
 * @typedef {object} PointImage
 * @property {Uint32Array} pixels
 * @property {number} width
 * @property {number} height
 * @property {number} ratio pixels per CSS pixel
 * @property {CanvasRenderingContext2D} context
 * @property {() => void} show
 */

// Every color vision tells blue from orange; where both places have points it is white.
const FIRST = 0xffff9e3d; // A B G R
const SECOND = 0xff2899ff;
export const FIRST_CSS = "#3d9eff";
export const SECOND_CSS = "#ff9928";
export const HANDLE_PX = 22;
export const RING_PX = 66;
const GROUND = 0xff18140f;
const MIXED = 0xffffffff;
const AGREEING = 0xff6b6058;
const AGREE_WITHIN_M = 0.05;
export const INK = "#e6ebf0";
export const HALO = "#0f1418";

/**
 * Image of the size of a canvas, to draw points into; null while it has no size.
 * @returns {PointImage | null}
 */
export function pointImage(/** @type {HTMLCanvasElement} */ canvas) {
  const ratio = Math.min(2, devicePixelRatio || 1);
  const width = Math.round(canvas.clientWidth * ratio);
  const height = Math.round(canvas.clientHeight * ratio);
  if (!width || !height) return null;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  const context = canvas.getContext("2d");
  if (!context) return null;
  const image = context.createImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer).fill(GROUND);
  return { pixels, width, height, ratio, context, show: () => context.putImageData(image, 0, 0) };
}

/**
 * Calls `plot(at)` for the pixels of points, two by two each. `pose` maps the points into the frame
 * that `upright` turns; `slab` is the range along the line of sight that is shown [m].
 * @param {PointImage} given
 * @param {Float32Array} points
 * @param {Projection & {pose: number[]}} given2
 * @param {(at: number) => unknown} plot
 */
function project({ width, height, ratio }, points, { pose, upright, camera, slab }, plot) {
  const R = times(upright, rotationOf(pose.slice(3)));
  const t = turn(upright, pose);
  const [x, y, eye] = camera.axes();
  const [cx, cy, cz] = camera.center;
  const scale = camera.scale * ratio;
  const row = (/** @type {number[]} */ a) =>
    [0, 1, 2].map((k) => a[0] * R[k] + a[1] * R[3 + k] + a[2] * R[6 + k]);
  const [X, Y, Z] = [row(x), row(y), row(eye)];
  const offset = (/** @type {number[]} */ a) =>
    a[0] * (t[0] - cx) + a[1] * (t[1] - cy) + a[2] * (t[2] - cz);
  const [ox, oy] = [offset(x), offset(y)];
  const oz = eye[0] * t[0] + eye[1] * t[1] + eye[2] * t[2];
  const [low, high] = slab;
  for (let k = 0; k < points.length; k += 3) {
    const [a, b, c] = [points[k], points[k + 1], points[k + 2]];
    const depth = Z[0] * a + Z[1] * b + Z[2] * c + oz;
    if (depth < low || depth > high) continue;
    const u = (width / 2 + scale * (X[0] * a + X[1] * b + X[2] * c + ox)) | 0;
    const v = (height / 2 - scale * (Y[0] * a + Y[1] * b + Y[2] * c + oy)) | 0;
    if (u < 0 || v < 0 || u >= width - 1 || v >= height - 1) continue;
    const p = v * width + u;
    const q = p + width;
    for (const at of [p, p + 1, q, q + 1]) plot(at);
  }
}

/**
 * Draws both places over each other; white where both have points.
 * @param {PointImage} image
 * @param {PairPoints} points
 * @param {PairPoses} poses
 * @param {Projection} projection
 */
export function drawBoth(image, points, poses, projection) {
  const { pixels } = image;
  const plot = (/** @type {number} */ color) => (/** @type {number} */ at) =>
    (pixels[at] = pixels[at] === GROUND || pixels[at] === color ? color : MIXED);
  project(image, points.i, { pose: poses.i, ...projection }, plot(FIRST));
  project(image, points.j, { pose: poses.j, ...projection }, plot(SECOND));
}

/**
 * Draws in color what one place has alone; returns the fraction of pixels that agree.
 * @param {PointImage} image
 * @param {PairPoints} points
 * @param {PairPoses} poses
 * @param {Projection} projection
 */
export function drawDifference(image, points, poses, projection) {
  const { pixels, width, ratio } = image;
  const marked = (/** @type {"i" | "j"} */ key) => {
    const mask = new Uint8Array(pixels.length);
    project(image, points[key], { pose: poses[key], ...projection }, (at) => (mask[at] = 1));
    return mask;
  };
  const reach = Math.max(1, Math.round(AGREE_WITHIN_M * projection.camera.scale * ratio));
  const { codes, agreeing } = difference(marked("i"), marked("j"), { width, reach });
  /** @type {Record<number, number>} */
  const colors = { [ONLY_FIRST]: FIRST, [ONLY_SECOND]: SECOND, [BOTH]: AGREEING };
  for (let at = 0; at < codes.length; at += 1)
    if (codes[at]) pixels[at] = colors[codes[at] ?? 0] ?? GROUND;
  return agreeing;
}

/** A disc to move the second place by, a ring with a knob to turn it. */
export function drawHandle(
  /** @type {CanvasRenderingContext2D} */ context,
  /** @type {number[]} */ [u, v],
) {
  context.strokeStyle = "#ffffff";
  context.fillStyle = "rgb(255 153 40 / 35%)";
  context.lineWidth = 2;
  context.beginPath();
  context.arc(u, v, HANDLE_PX / 2, 0, 7);
  context.fill();
  context.stroke();
  context.beginPath();
  context.moveTo(u - 17, v);
  context.lineTo(u + 17, v);
  context.moveTo(u, v - 17);
  context.lineTo(u, v + 17);
  context.stroke();
  context.setLineDash([6, 5]);
  context.beginPath();
  context.arc(u, v, RING_PX, 0, 7);
  context.stroke();
  context.setLineDash([]);
  context.fillStyle = "#ffffff";
  context.beginPath();
  context.arc(u + RING_PX, v, 7, 0, 7);
  context.fill();
}

/**
 * Numbers the points picked in both places; `toScreen` maps from the first place's frame.
 * @param {CanvasRenderingContext2D} context
 * @param {Picking} picking
 * @param {number[]} pose
 * @param {(p: number[]) => number[]} toScreen
 */
export function drawPicked(context, picking, pose, toScreen) {
  /** @type {Array<[number[], number, string]>} */
  const pins = [
    ...picking.i.map((p, k) => /** @type {[number[], number, string]} */ ([p, k, "#9ccbff"])),
    ...picking.j.map(
      (p, k) => /** @type {[number[], number, string]} */ ([apply(pose, p), k, "#ffc98a"]),
    ),
  ];
  context.font = "bold 14px system-ui, sans-serif";
  for (const [p, k, color] of pins) {
    const [u, v] = toScreen(p);
    context.strokeStyle = context.fillStyle = color;
    context.lineWidth = 2;
    context.strokeRect(u - 6, v - 6, 12, 12);
    context.fillText(String(k + 1), u + 9, v - 8);
  }
}
