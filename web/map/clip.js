// What of the map is shown: heights, a box, a section. Planes (n, d) keep n · p + d >= 0.

/**
 * @import {Xyz} from "./camera.js"
 * @typedef {[number | null, number | null]} Heights lowest and highest [m]; null = no limit
 * @typedef {object} ClipBox
 * @property {[number, number, number]} center [m]
 * @property {[number, number, number]} size [m]
 * @property {number} yaw of its first edge, counterclockwise from x [rad]
 * @typedef {object} Section a vertical slice, seen from its right side
 * @property {[number, number]} a [m]
 * @property {[number, number]} b
 * @property {number} thickness [m]
 * @typedef {{heights: Heights, box: ClipBox | null, section: Section | null}} Clip
 */

const MOST_SLICE_M = 100; // thickness of a slice
const AROUND_M = 1; // beyond all points: those at the border are inside

/** All planes of a clip. */
export function planesOf(/** @type {Clip} */ { heights: [low, high], box, section }) {
  const planes = [];
  if (low !== null) planes.push([0, 0, 1, -low]);
  if (high !== null) planes.push([0, 0, -1, high]);
  if (box) planes.push(...planesOfBox(box));
  if (section) planes.push(...planesOfSection(section));
  return planes;
}

/** Unit vectors along the edges of a box. @returns {Xyz[]} */
export function axesOfBox(/** @type {number} */ yaw) {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  return [
    [c, s, 0],
    [-s, c, 0],
    [0, 0, 1],
  ];
}

function planesOfBox(/** @type {ClipBox} */ { center, size, yaw }) {
  return axesOfBox(yaw).flatMap((axis, k) => {
    const at = axis[0] * center[0] + axis[1] * center[1] + axis[2] * center[2];
    const half = size[k] / 2;
    return [
      [...axis, half - at],
      [-axis[0], -axis[1], -axis[2], half + at],
    ];
  });
}

/** Unit vector across a section, to the side from which it is seen. @returns {Xyz} */
export function acrossOf(/** @type {Section} */ { a, b }) {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(dx, dy) || 1;
  return [dy / length, -dx / length, 0];
}

function planesOfSection(/** @type {Section} */ section) {
  const n = acrossOf(section);
  const at = n[0] * section.a[0] + n[1] * section.a[1];
  const half = section.thickness / 2;
  return [
    [...n, half - at],
    [-n[0], -n[1], 0, half + at],
  ];
}

/** The yaw of a camera that looks straight at a section, with a to the left of b. */
export function yawOfSection(/** @type {Section} */ section) {
  const [nx, ny] = acrossOf(section);
  return Math.atan2(-nx, -ny);
}

/** The eight corners of a clip box [m]; bits of the index: x, y, z. */
export function cornersOfBox(/** @type {ClipBox} */ { center, size, yaw }) {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  return Array.from({ length: 8 }, (_, k) => {
    const [x, y, z] = [0, 1, 2].map((axis) => ((k >> axis) & 1 ? 0.5 : -0.5) * size[axis]);
    return [center[0] + c * x - s * y, center[1] + s * x + c * y, center[2] + z];
  });
}

/**
 * Boxes inside of which a point is shown, as an export takes them: middle and edges [m], turn [°].
 * @param {Clip} clip
 * @param {{low_m: number[], high_m: number[]}} map corners of all points
 */
export function exportedClip({ heights: [low, high], box, section }, { low_m, high_m }) {
  const least = low ?? low_m[2] - AROUND_M;
  const most = high ?? high_m[2] + AROUND_M;
  const [x, y] = [0, 1].map((k) => (low_m[k] + high_m[k]) / 2);
  const [dx, dy] = [0, 1].map((k) => high_m[k] - low_m[k] + 2 * AROUND_M);
  const tall = (/** @type {number} */ a, /** @type {number} */ b) => [(a + b) / 2, b - a];
  const boxes = [];
  if (box) {
    const [bx, by, bz] = box.center;
    const [bottom, top] = [bz - box.size[2] / 2, bz + box.size[2] / 2];
    const [z, dz] = tall(Math.max(least, bottom), Math.min(most, top));
    boxes.push([bx, by, z, box.size[0], box.size[1], dz, degrees(box.yaw)]);
  }
  const [z, dz] = tall(least, most);
  if (section) {
    const [nx, ny] = acrossOf(section);
    const off = nx * (section.a[0] - x) + ny * (section.a[1] - y);
    const middle = [x + off * nx, y + off * ny, z];
    const size = [section.thickness, Math.hypot(dx, dy), dz];
    boxes.push([...middle, ...size, degrees(Math.atan2(ny, nx))]);
  }
  if (!boxes.length && (low !== null || high !== null)) boxes.push([x, y, z, dx, dy, dz, 0]);
  return boxes;
}

const degrees = (/** @type {number} */ rad) => (rad * 180) / Math.PI;

/** The query of the page of a project whose form of exports takes only such boxes. */
export const exportQuery = (/** @type {number[][]} */ boxes) =>
  boxes.map((box) => `clip=${box.map((x) => Number(x.toFixed(5))).join(",")}`).join("&") || "clip=";

/**
 * The box over a rectangle whose opposite corners were dragged in an image from above.
 * @param {number[]} a
 * @param {number[]} b
 * @param {{yaw: number, heights: [number, number]}} look yaw of the image's right side
 * @returns {ClipBox}
 */
export function boxOver(a, b, { yaw, heights }) {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  return {
    center: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (heights[0] + heights[1]) / 2],
    size: [
      Math.max(Math.abs(c * dx + s * dy), 0.05),
      Math.max(Math.abs(-s * dx + c * dy), 0.05),
      heights[1] - heights[0],
    ],
    yaw,
  };
}

/**
 * A vertical strip as the page of slices has it in its address.
 * @param {{a_m: [number, number], b_m: [number, number], thickness_m: number}} strip
 */
export function sliceQuery({ a_m, b_m, thickness_m }) {
  const [a, b] = [a_m, b_m].map((p) => p.map((x) => x.toFixed(3)).join(","));
  return `kind=vertical&a=${a}&b=${b}&t=${Math.min(thickness_m, MOST_SLICE_M)}`;
}
