// What is cut and how it is shown; the address of the page is this state. No DOM, no network.

import { t } from "../shared/texts.js";
/**
 * @import {SliceImageRequest, SlicePlaneSpec} from "../shared/http_types"
 * @typedef {"horizontal" | "vertical" | "free"} Kind of a slice
 * @typedef {NonNullable<SliceImageRequest["color"]>} Color
 * @typedef {NonNullable<SliceImageRequest["surface"]>} Surface
 * @typedef {object} SliceState
 * @property {Kind} kind
 * @property {number} z height of a horizontal slice [m]
 * @property {number[]} a one end of a vertical slice [m]
 * @property {number[]} b the other end
 * @property {number[]} o a point of a free slice
 * @property {number[]} n its normal
 * @property {number} t thickness [m]
 * @property {number} step [m]
 * @property {number} count of slices that are exported or compared
 * @property {number} spacing of those [m]
 * @property {Color} color
 * @property {string} ref the reference
 * @property {"plane" | "point"} method of the distances
 * @property {string} beside map of the second slice
 * @property {Color | ""} besideColor
 * @property {string} source map of the first slice
 * @property {Surface} surface
 * @property {string} mark both ends of the stretch of a finding, x,y,z,x,y,z
 * @property {string} span its times, from,to [s]
 * @property {number | null} lo low end of the colors
 * @property {number | null} hi
 * @property {number | null} u middle of the view
 * @property {number | null} v
 * @property {number | null} m meters per pixel
 * @property {boolean} given whether the address names a slice
 */

const NUMBERS = { z: 1.5, t: 0.1, step: 0.1, count: 1, spacing: 0.5 };
/** @type {Record<string, number[]>} */
const LISTS = { a: [0, 0], b: [1, 0], o: [0, 0, 0], n: [0, 0, 1] };
/** @type {Record<string, string>} */
const WORDS = {
  kind: "horizontal",
  color: "height",
  ref: "",
  method: "plane",
  beside: "",
  besideColor: "",
  source: "",
  surface: "fitted",
  mark: "",
  span: "",
};
const MAYBE = ["lo", "hi", "u", "v", "m"];

/** @type {Record<Color, string>} */
export const COLORS = {
  height: t("color-height"),
  intensity: t("color-intensity"),
  normalized: t("color-normalized"),
  time: t("color-time"),
  sensor: t("color-sensor"),
  distance: t("color-distance"),
};

/**
 * Where the points are drawn.
 * @type {Record<Surface, string>}
 */
export const SURFACES = {
  fitted: t("surface-fitted"),
  raw: t("surface-raw"),
  strays: t("surface-strays"),
};

/** The state in the query of an address; an invalid value becomes the default. */
export function parse(/** @type {string} */ query) {
  const given = new URLSearchParams(query);
  const number = (/** @type {string | null} */ text, /** @type {any} */ usual) =>
    text !== null && text !== "" && Number.isFinite(Number(text)) ? Number(text) : usual;
  /** @type {Record<string, any>} */
  const state = {};
  for (const [key, usual] of Object.entries(NUMBERS)) state[key] = number(given.get(key), usual);
  for (const key of MAYBE) state[key] = number(given.get(key), null);
  for (const [key, usual] of Object.entries(WORDS)) state[key] = given.get(key) ?? usual;
  for (const [key, usual] of Object.entries(LISTS)) {
    const list = (given.get(key) ?? "").split(",").map((text) => number(text, NaN));
    state[key] = list.length === usual.length && list.every(Number.isFinite) ? list : [...usual];
  }
  if (!["horizontal", "vertical", "free"].includes(state.kind)) state.kind = "horizontal";
  if (!(state.color in COLORS)) state.color = "height";
  if (!(state.surface in SURFACES)) state.surface = "fitted";
  if (!(state.t > 0)) state.t = NUMBERS.t;
  return /** @type {SliceState} */ ({ ...state, given: given.has("kind") });
}

const short = (/** @type {number} */ x) => String(Number(x.toFixed(4)));

/** The query that `parse` reads; only what differs from the default. */
export function format(/** @type {SliceState} */ state) {
  /** @type {Record<string, any>} */
  const values = state;
  const query = new URLSearchParams({ kind: state.kind });
  const used = { horizontal: ["z"], vertical: ["a", "b"], free: ["o", "n"] }[state.kind];
  for (const key of used) query.set(key, [values[key]].flat().map(short).join(","));
  for (const [key, usual] of Object.entries(NUMBERS))
    if (key !== "z" && values[key] !== usual) query.set(key, short(values[key]));
  for (const key of MAYBE)
    if (values[key] !== null)
      query.set(key, key === "m" ? String(Number(values[key].toPrecision(5))) : short(values[key]));
  for (const [key, usual] of Object.entries(WORDS))
    if (key !== "kind" && values[key] !== usual) query.set(key, values[key]);
  return query.toString().replaceAll("%2C", ",").replaceAll("%3A", ":");
}

/** @returns {[number, number]} */
const pair = (/** @type {number[]} */ [x = 0, y = 0]) => [x, y];
/** @returns {[number, number, number]} */
const triple = (/** @type {number[]} */ [x = 0, y = 0, z = 0]) => [x, y, z];

/**
 * The slice as the server expects it.
 * @returns {SlicePlaneSpec}
 */
export function planeOf(/** @type {SliceState} */ state) {
  const thickness_m = state.t;
  if (state.kind === "horizontal") return { kind: state.kind, z_m: state.z, thickness_m };
  if (state.kind === "vertical")
    return { kind: state.kind, a_m: pair(state.a), b_m: pair(state.b), thickness_m };
  return { kind: state.kind, origin_m: triple(state.o), normal: triple(state.n), thickness_m };
}

/** Unit normal of the slice, the same as on the server. */
export function normalOf(/** @type {SliceState} */ state) {
  if (state.kind === "horizontal") return [0, 0, 1];
  if (state.kind === "vertical") {
    const [dx, dy] = [state.b[0] - state.a[0], state.b[1] - state.a[1]];
    const length = Math.hypot(dx, dy) || 1;
    return [dy / length, -dx / length, 0];
  }
  const length = Math.hypot(...state.n) || 1;
  return state.n.map((x) => x / length);
}

/** Origin and axes of the coordinates u and v of the slice, the same as on the server. */
export function axesOf(/** @type {SliceState} */ state) {
  const n = normalOf(state);
  const origin_m = triple(originOf(state));
  if (state.kind === "horizontal") return { origin_m, u: triple([1, 0, 0]), v: triple([0, 1, 0]) };
  if (state.kind === "vertical")
    return { origin_m, u: triple([-n[1], n[0], 0]), v: triple([0, 0, 1]) };
  const cross = (/** @type {number[]} */ a, /** @type {number[]} */ b) =>
    [0, 1, 2].map((k) => a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
  const across = cross(Math.abs(n[2]) < 0.999 ? [0, 0, 1] : [0, 1, 0], n);
  const length = Math.hypot(...across);
  const u = across.map((x) => x / length);
  return { origin_m, u: triple(u), v: triple(cross(n, u)) };
}

/** A point of the plane of the slice. */
const originOf = (/** @type {SliceState} */ state) =>
  ({
    horizontal: () => [0, 0, state.z],
    vertical: () => [...state.a, 0],
    free: () => state.o,
  })[state.kind]();

/**
 * How far a point lies from the plane of the slice [m].
 * @param {SliceState} state
 * @param {number[]} p
 */
export function distanceFrom(state, p) {
  const n = normalOf(state);
  const on = originOf(state);
  return Math.abs(p.reduce((sum, x, k) => sum + (x - on[k]) * n[k], 0));
}

/**
 * The same slice farther along its normal.
 * @param {SliceState} state
 * @param {number} distance
 */
export function moved(state, distance) {
  const n = normalOf(state);
  const shift = (/** @type {number[]} */ p) => p.map((x, k) => x + distance * n[k]);
  if (state.kind === "horizontal") return { ...state, z: state.z + distance };
  if (state.kind === "vertical") return { ...state, a: shift(state.a), b: shift(state.b) };
  return { ...state, o: shift(state.o) };
}

const MOST_PX = 4096; // per side, as `MAX_SIDE_PX` of the server
const LEAST_PX = 16;

/**
 * Pixels to request of an image shown at a size [CSS px]; a huge screen gets coarser ones.
 * @param {number} width
 * @param {number} height
 * @param {number} ratio
 */
export function imageSize(width, height, ratio) {
  const scale = Math.min(2, ratio || 1, MOST_PX / Math.max(width, height, 1));
  const [across, up] = [width, height].map((side) => Math.max(LEAST_PX, Math.round(side * scale)));
  return { width: across, height: up };
}

/**
 * The state without the view: horizontal, vertical and free slices have different coordinates, so
 * the view of one is invalid in another.
 */
export const unframed = (/** @type {SliceState} */ state) => ({
  ...state,
  u: null,
  v: null,
  m: null,
});

/** Azimuth (clockwise from y) and tilt (0 = level plane) of a normal, in degrees. */
export function anglesOf(/** @type {number[]} */ [x, y, z]) {
  const flat = Math.hypot(x, y);
  return {
    azimuth: (Math.round((Math.atan2(x, y) * 1800) / Math.PI) / 10 + 360) % 360,
    tilt: Math.round((Math.atan2(flat, z) * 1800) / Math.PI) / 10,
  };
}

export function normalFrom(/** @type {{azimuth: number, tilt: number}} */ { azimuth, tilt }) {
  const [a, t] = [(azimuth * Math.PI) / 180, (tilt * Math.PI) / 180];
  return [Math.sin(t) * Math.sin(a), Math.sin(t) * Math.cos(a), Math.cos(t)];
}

/** The query of an address without its plane. */
export function withoutPlane(/** @type {string} */ query) {
  const left = new URLSearchParams(query);
  for (const key of ["kind", "u", "v", "m"]) left.delete(key);
  return left;
}

/**
 * A plane of another kind: through the middle of what is seen of a horizontal one, else of the map.
 * @param {Kind} kind
 * @param {SliceState} state
 * @param {number[][]} bounds_m lowest and highest coordinates of the map
 * @param {{u: number, v: number} | null} seen middle of what is seen
 * @returns {Partial<SliceState>}
 */
export function startOf(kind, state, [low, high], seen) {
  const middle = low.map((x, k) => (x + high[k]) / 2);
  const at = seen ? [seen.u, seen.v] : middle;
  if (kind === "horizontal")
    return { kind, z: state.given ? state.z : low[2] + Math.min(1.2, (high[2] - low[2]) / 2) };
  if (kind === "vertical") {
    const wide = high[0] - low[0] >= high[1] - low[1];
    return wide
      ? { kind, a: [low[0], at[1]], b: [high[0], at[1]] }
      : { kind, a: [at[0], low[1]], b: [at[0], high[1]] };
  }
  return { kind, o: [...at.slice(0, 2), middle[2]], n: normalFrom({ azimuth: 0, tilt: 45 }) };
}
