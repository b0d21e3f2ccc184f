// Captions of slices, of points picked on them and of distances. No DOM, no network.

import { decimal, language, t } from "../shared/texts.js";
import { COLORS, SURFACES } from "./state.js";

/** @import {OtherMap, PickView, PlanePosition, SliceFacts} from "../shared/http_types" */

const KINDS = {
  horizontal: t("kind-horizontal"),
  vertical: t("kind-vertical"),
  free: t("kind-free"),
};
const fixed = (/** @type {number[]} */ xs) => xs.map((x) => decimal(x, 3)).join("  ");

/** The position of a plane. */
export function planeText(/** @type {PlanePosition} */ { kind, normal, offset_m, azimuth_deg }) {
  const offset = decimal(offset_m, 3);
  if (kind === "horizontal") return `z = ${offset} m`;
  if (kind === "vertical") return t("plane-vertical", { azimuth: decimal(azimuth_deg, 1), offset });
  const axes = normal.map((x) => decimal(x, 3)).join(language() === "en" ? ", " : "; ");
  return t("plane-free", { normal: axes, offset });
}

/** The kind of the slice and its position. */
export const cutText = (/** @type {PlanePosition} */ position) =>
  `${KINDS[position.kind]} ${planeText(position)}`;

/** The name of another map: an earlier one, or that of another project. */
export const sourceText = (/** @type {OtherMap} */ { kind, name }) =>
  kind === "project" ? t("source-project", { name }) : t("source-earlier", { time: name });

/**
 * What a slice image shows.
 * @param {Pick<import("./state.js").SliceState, "source" | "color" | "surface"> &
 *   {points: string}} image
 * @param {OtherMap[]} sources
 */
export function imageText({ source, color, points, surface }, sources) {
  const other = sources.find((one) => one.id === source);
  const name = other ? sourceText(other) : source || t("this-map");
  return t("image-text", { name, color: COLORS[color], points, surface: SURFACES[surface] });
}

/**
 * Coordinates and attributes of a picked point.
 * @param {Pick<PickView, "p_map" | "p_crs" | "about"> & Partial<Pick<PickView, "target">>} given
 * @param {Pick<SliceFacts, "crs" | "sensors">} given1
 */
export function pointText({ p_map, p_crs, about, target }, { crs, sensors }) {
  const parts = [`x y z  ${fixed(p_map)} m`];
  if (p_crs) parts.push(`${crs}  E N H  ${fixed(p_crs)} m`);
  if (about.intensity !== undefined)
    parts.push(t("intensity-of", { value: String(about.intensity) }));
  if (sensors.length) parts.push(sensors[about.sensor] ?? t("sensor-of", { number: about.sensor }));
  if (about.time_s !== undefined)
    parts.push(t("time-of", { s: about.time_s, frame: String(about.frame_id) }));
  if (target) {
    const mm = (/** @type {number} */ m) => decimal(1000 * m, 1);
    parts.push(t("target-near", { off: mm(target.off_m), sd: mm(target.sd_m) }));
  }
  return parts.join(" · ");
}

/**
 * @param {Pick<PickView, "p_map">} a
 * @param {Pick<PickView, "p_map">} b
 */
function lengths(a, b) {
  const d = b.p_map.map((x, k) => x - a.p_map[k]);
  return { all: Math.hypot(...d), flat: Math.hypot(d[0], d[1]), up: d[2] };
}

/**
 * The distance of two picked points, to stand beside the line between them.
 * @param {Pick<PickView, "p_map">} a
 * @param {Pick<PickView, "p_map">} b
 */
export const lengthText = (a, b) => `${decimal(lengths(a, b).all, 3)} m`;

/**
 * The distance of two picked points in full.
 * @param {Pick<PickView, "p_map">} a
 * @param {Pick<PickView, "p_map">} b
 */
export function distanceText(a, b) {
  const { all, flat, up } = lengths(a, b);
  return [
    t("distance", { m: all }),
    t("horizontal-part", { m: flat }),
    t("vertical-part", { m: up }),
    t("from-to", { from: fixed(a.p_map), to: fixed(b.p_map) }),
  ].join(" · ");
}
