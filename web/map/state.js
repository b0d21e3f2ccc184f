// What the page shows; the address of the page is this state. No DOM, no network.

import { t } from "../shared/texts.js";
import { NOT_COMPARED, comparedIn, comparedQuery } from "./compare_state.js";
import { KINDS } from "./measure.js";

/**
 * @import {Camera, Xyz} from "./camera.js"
 * @import {Clip} from "./clip.js"
 * @import {Measurement, MeasureKind} from "./measure.js"
 * @import {Mark} from "./places.js"
 * @import {Compared} from "./compare_state.js"
 * @typedef {"height" | "intensity" | "normalized" | "class" | "time" | "uncertainty"
 *   | "thickness" | "plain"} ColorBy
 * @typedef {"findings" | "marks" | "notes" | "walk" | "nodes"} Layer
 * @typedef {object} MapState
 * @property {Camera | null} camera null = all of the map
 * @property {ColorBy | null} color null = the usual one of the map
 * @property {number | null} lo low end of the colors; null = the usual one
 * @property {number | null} hi
 * @property {Clip} clip
 * @property {boolean} cutCeiling whether the heights are those of the map's storey
 * @property {Layer[]} layers
 * @property {boolean} depth whether edges are shaded by depth
 * @property {number} size points are drawn this many times as large as they are apart
 * @property {boolean} standing whether a drag looks around
 * @property {Measurement[]} measurements
 * @property {Mark | null} mark the stretch or place that is marked
 * @property {Compared} compare what is shown of another map
 */

/** @type {Record<ColorBy, string>} */
export const COLORS = {
  normalized: t("color-normalized"),
  intensity: t("color-intensity"),
  height: t("color-height"),
  class: t("color-class"),
  time: t("color-time"),
  uncertainty: t("color-uncertainty"),
  thickness: t("color-thickness"),
  plain: t("color-plain"),
};
/** @type {Record<Layer, string>} */
export const LAYERS = {
  findings: t("layer-findings"),
  marks: t("layer-marks"),
  notes: t("layer-notes"),
  walk: t("layer-walk"),
  nodes: t("layer-nodes"),
};
/** @type {Layer[]} */
const USUAL_LAYERS = ["findings", "marks", "notes"];
const MOST_MEASUREMENTS = 100;
const MOST_M = 1e7;

const short = (/** @type {number} */ x, digits = 3) => String(Number(x.toFixed(digits)));
const list = (/** @type {number[]} */ values, digits = 3) =>
  values.map((x) => short(x, digits)).join(",");

/**
 * Numbers of a text, as many as expected; null if it is not that.
 * @param {string | null} text
 * @param {number} count
 */
function numbers(text, count) {
  const parts = text?.split(",") ?? [];
  const values = parts.map((part) => (part.trim() === "" ? NaN : Number(part)));
  const sound = values.every((x) => Number.isFinite(x) && Math.abs(x) <= MOST_M);
  return parts.length === count && sound ? values : null;
}

/** @returns {number | null} */
const number = (/** @type {string | null} */ text) => numbers(text, 1)?.[0] ?? null;

/** @returns {MapState} */
const usualState = () => ({
  camera: null,
  color: null,
  lo: null,
  hi: null,
  clip: { heights: [null, null], box: null, section: null },
  cutCeiling: true,
  layers: [...USUAL_LAYERS],
  depth: true,
  size: 1,
  standing: false,
  measurements: [],
  mark: null,
  compare: NOT_COMPARED,
});

/** The state in the query of an address; what is not valid becomes the usual. */
export function parse(/** @type {string} */ query) {
  const given = new URLSearchParams(query);
  const state = usualState();
  state.camera = cameraOf(given.get("camera"));
  const color = given.get("color") ?? "";
  if (Object.hasOwn(COLORS, color)) state.color = /** @type {ColorBy} */ (color);
  state.lo = number(given.get("lo"));
  state.hi = number(given.get("hi"));
  const heights = given.get("z");
  state.cutCeiling = heights === null;
  if (heights?.includes("..")) {
    const [low, high] = heights.split("..");
    state.clip.heights = [number(low), number(high)];
  }
  const box = numbers(given.get("box"), 7);
  if (box && box.slice(3, 6).every((x) => x > 0))
    state.clip.box = {
      center: /** @type {Xyz} */ (box.slice(0, 3)),
      size: /** @type {Xyz} */ (box.slice(3, 6)),
      yaw: box[6],
    };
  const cut = numbers(given.get("section"), 5);
  if (cut && cut[4] > 0 && (cut[0] !== cut[2] || cut[1] !== cut[3]))
    state.clip.section = { a: [cut[0], cut[1]], b: [cut[2], cut[3]], thickness: cut[4] };
  const layers = given.get("layers")?.split(",") ?? USUAL_LAYERS;
  state.layers = /** @type {Layer[]} */ (Object.keys(LAYERS).filter((one) => layers.includes(one)));
  state.depth = given.get("depth") !== "0";
  const size = number(given.get("size"));
  if (size !== null) state.size = Math.min(4, Math.max(0.25, size));
  state.standing = given.get("standing") === "1" && !state.camera?.parallel;
  state.measurements = given.getAll("m").slice(0, MOST_MEASUREMENTS).flatMap(measurementOf);
  state.mark = markOf(given);
  state.compare = comparedIn(given);
  return state;
}

/** The stretch or place that a link marks, as of a finding; null = none. @returns {Mark | null} */
function markOf(/** @type {URLSearchParams} */ given) {
  const span = numbers(given.get("span"), 2);
  const place = numbers(given.get("place"), 6);
  if (!span && !place) return null;
  return {
    span: span ? /** @type {[number, number]} */ (span.sort((a, b) => a - b)) : null,
    place: place ? [place.slice(0, 3), place.slice(3)] : [],
  };
}

/** @returns {Camera | null} */
function cameraOf(/** @type {string | null} */ text) {
  const values = numbers(text, 7);
  if (!values || values[5] <= 0) return null;
  const [x, y, z, yaw, pitch, distance, parallel] = values;
  const rad = Math.PI / 180;
  const steep = Math.min(90, Math.max(-90, pitch));
  return {
    target: [x, y, z],
    yaw: yaw * rad,
    pitch: steep * rad,
    distance,
    parallel: parallel === 1,
  };
}

/** @type {Array<[string, string]>} what a point snapped to, and its letter in an address */
const SNAPS = [
  ["corner", "c"],
  ["edge", "e"],
  ["plane", "p"],
];

/** A point "x,y,z,sd,snap" of a measurement; standard deviation and letter may be left out. */
function pointOf(/** @type {string} */ text) {
  const [sd, letter] = text.split(",").slice(3);
  const p = numbers(text.split(",").slice(0, 3).join(), 3);
  const snap = SNAPS.find(([, one]) => one === letter)?.[0] ?? "";
  const known = sd ? Number(sd) : NaN;
  return p && { p, sd: known >= 0 && known <= MOST_M ? known : NaN, snap };
}

/**
 * Points of a measurement as `pointOf` reads them.
 * @param {Measurement} measurement
 */
const pointTexts = ({ points, sd, snaps }) =>
  points.map((p, k) => {
    const known = Number.isFinite(sd?.[k]) ? short(/** @type {number[]} */ (sd)[k], 5) : "";
    const letter = SNAPS.find(([name]) => name === snaps?.[k])?.[1] ?? "";
    return [list(p), known, letter].join(",").replace(/,+$/, "");
  });

/** A measurement "kind:figure;point;…;name" as a list of one, or none if it is not valid. */
function measurementOf(/** @type {string} */ text) {
  const [head, ...rest] = text.split(";");
  const [kind, given] = head.split(":");
  const name = rest.pop() ?? "";
  const points = rest.flatMap((part) => pointOf(part) ?? []);
  if (!Object.hasOwn(KINDS, kind)) return [];
  const { least, most } = KINDS[/** @type {MeasureKind} */ (kind)];
  if (points.length < least || points.length > most) return [];
  if (points.length < rest.length) return [];
  return [
    {
      kind: /** @type {MeasureKind} */ (kind),
      points: points.map(({ p }) => p),
      name: name.slice(0, 80),
      sd: points.map(({ sd }) => sd),
      snaps: points.map(({ snap }) => snap),
      ...(given === undefined ? {} : { figure: figureOf(kind, given) }),
    },
  ];
}

/**
 * Width of a profile, or height of the base of a volume [m]; null = the usual.
 * @param {string} kind
 * @param {string} text
 */
function figureOf(kind, text) {
  const value = number(text);
  if (kind === "profile") return value !== null && value > 0 && value <= 100 ? value : null;
  return kind === "volume" ? value : null;
}

const headOf = (/** @type {string} */ kind, /** @type {number | null | undefined} */ figure) =>
  figure === null || figure === undefined ? kind : `${kind}:${short(figure)}`;

/** The query of an address that shows this state. */
export function format(/** @type {MapState} */ state) {
  const query = new URLSearchParams();
  const { camera, clip } = state;
  const deg = 180 / Math.PI;
  if (camera) {
    const { target, yaw, pitch, distance, parallel } = camera;
    query.set(
      "camera",
      `${list(target)},${list([yaw * deg, pitch * deg], 2)},${short(distance)},${Number(parallel)}`,
    );
  }
  if (state.color) query.set("color", state.color);
  if (state.lo !== null) query.set("lo", String(state.lo));
  if (state.hi !== null) query.set("hi", String(state.hi));
  if (!state.cutCeiling)
    query.set("z", clip.heights.map((z) => (z === null ? "" : short(z))).join(".."));
  if (clip.box) {
    const { center, size, yaw } = clip.box;
    query.set("box", `${list([...center, ...size])},${short(yaw, 5)}`);
  }
  if (clip.section) {
    const { a, b, thickness } = clip.section;
    query.set("section", list([...a, ...b, thickness]));
  }
  if (state.layers.join() !== USUAL_LAYERS.join()) query.set("layers", state.layers.join(","));
  if (!state.depth) query.set("depth", "0");
  if (state.size !== 1) query.set("size", short(state.size, 2));
  if (state.standing) query.set("standing", "1");
  comparedQuery(state.compare, query);
  if (state.mark?.span) query.set("span", list(state.mark.span));
  if (state.mark?.place.length) query.set("place", list(state.mark.place.flat()));
  for (const one of state.measurements) {
    const head = headOf(one.kind, one.figure);
    query.append("m", [head, ...pointTexts(one), one.name.replaceAll(";", " ")].join(";"));
  }
  return query.toString().replaceAll("%2C", ",").replaceAll("%3B", ";").replaceAll("%3A", ":");
}
