// Error ellipses of control and check points in a slice, enlarged. No DOM, no network.

import { axesOf } from "./state.js";

/**
 * @import {ErrorEllipse, Residual} from "../shared/http_types"
 * @import {Mark} from "./marks.js"
 * @import {SliceState} from "./state.js"
 * @typedef {object} KnownPlace a point that was measured in this map
 * @property {string} id
 * @property {number[]} at in the map [m]
 * @property {ErrorEllipse | null} map what the map states of this place (1 σ)
 * @property {ErrorEllipse | null} survey what the survey states of the point (1 σ)
 */

/** Ellipses are this many times as large as the deviations: some millimeters are not to be seen. */
export const ENLARGED = 100;
/** Points so far from the plane are shown [m]. */
const NEAR_M = 0.5;
const CORNERS = 48;

/**
 * Points that were measured in this map, with what is stated of them.
 * @param {Record<string, number[]>} picks id -> place in the map [m]
 * @param {Residual[]} rows
 * @returns {KnownPlace[]}
 */
export function knownPlaces(picks, rows) {
  return rows
    .filter((one) => one.id in picks)
    .map(({ id, stated, survey }) => ({ id, at: picks[id] ?? [], map: stated, survey }));
}

/**
 * Ellipses of the points near a slice: of the map with the name, of the survey in another color.
 * @param {SliceState} state
 * @param {KnownPlace[]} places
 * @returns {Mark[]}
 */
export function ellipseMarks(state, places) {
  const { origin_m, u, v } = axesOf(state);
  const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const along = (/** @type {number[]} */ p, /** @type {number[]} */ axis) =>
    axis.reduce((sum, a, k) => sum + a * (p[k] - origin_m[k]), 0);
  return places.flatMap(({ id, at, map, survey }) => {
    if (Math.abs(along(at, n)) > state.t / 2 + NEAR_M) return [];
    const center = [along(at, u), along(at, v)];
    /** @type {Mark[]} */
    const marks = [];
    if (survey) marks.push({ points: outline(survey, u, v, center), dots: [], tone: "--good" });
    if (map) marks.push({ points: outline(map, u, v, center), dots: [], tone: "--mark" });
    marks.push({ points: [center], text: id });
    return marks;
  });
}

/**
 * The outline of the covariance in the plane of a slice, closed.
 * @param {ErrorEllipse} one
 * @param {number[]} u
 * @param {number[]} v
 * @param {number[]} center
 */
function outline(one, u, v, center) {
  const turn = (one.azimuth_deg * Math.PI) / 180;
  /** @type {Array<[number, number[]]>} axes of the ellipsoid: deviation and direction */
  const axes = [
    [one.major_m, [Math.sin(turn), Math.cos(turn), 0]],
    [one.minor_m, [Math.cos(turn), -Math.sin(turn), 0]],
    [one.up_m, [0, 0, 1]],
  ];
  const dot = (/** @type {number[]} */ a, /** @type {number[]} */ b) =>
    a.reduce((sum, x, k) => sum + x * b[k], 0);
  const sum = (/** @type {number[]} */ a, /** @type {number[]} */ b) =>
    axes.reduce((whole, [sd, axis]) => whole + sd * sd * dot(axis, a) * dot(axis, b), 0);
  const [uu, uv, vv] = [sum(u, u), sum(u, v), sum(v, v)];
  // Lower triangular root L of the covariance: L (cos, sin) runs around the ellipse.
  const a = Math.sqrt(uu) || 1e-9;
  const b = uv / a;
  const c = Math.sqrt(Math.max(vv - b * b, 0));
  return Array.from({ length: CORNERS + 1 }, (_, k) => {
    const angle = (2 * Math.PI * k) / CORNERS;
    const [x, y] = [Math.cos(angle), Math.sin(angle)];
    return [center[0] + ENLARGED * a * x, center[1] + ENLARGED * (b * x + c * y)];
  });
}
