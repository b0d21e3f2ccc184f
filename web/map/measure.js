// Measurements on points of the map: mathematics, captions, CSV. No DOM, no network.

import { decimal, t } from "../shared/texts.js";
import { add, dot, lengthOf, minus } from "./camera.js";

/**
 * @import {MapVolume, PointsInCrs} from "../shared/http_types"
 * @typedef {"point" | "distance" | "height" | "angle" | "area" | "profile" | "volume"} MeasureKind
 * @typedef {object} Measurement
 * @property {MeasureKind} kind
 * @property {number[][]} points in the map [m]
 * @property {string} name
 * @property {number[]} [sd] standard deviations of the points' places [m]; NaN = not stated
 * @property {string[]} [snaps] what each point snapped to; "" = nothing
 * @property {number | null} [figure] width of a profile, height of the base of a volume [m]
 */

/** @type {Record<MeasureKind, {text: string, least: number, most: number, hint: string}>} */
export const KINDS = {
  point: { text: t("kind-point"), least: 1, most: 1, hint: t("hint-point") },
  distance: { text: t("kind-distance"), least: 2, most: 2, hint: t("hint-distance") },
  height: { text: t("kind-height"), least: 2, most: 2, hint: t("hint-height") },
  angle: { text: t("kind-angle"), least: 3, most: 3, hint: t("hint-angle") },
  area: { text: t("kind-area"), least: 3, most: Infinity, hint: t("hint-area") },
  profile: { text: t("kind-profile"), least: 2, most: 2, hint: t("hint-profile") },
  volume: {
    text: t("kind-volume"),
    least: 3,
    most: 500,
    hint: t("hint-volume"),
  },
};
export const PROFILE_M = 0.2; // usual width of the strip of a profile
const VOLUME = { above_m3: NaN, below_m3: NaN, sd_m3: NaN };

const meters = (/** @type {number} */ m) => `${decimal(Math.round(1000 * m) / 1000 + 0, 3)} m`;

/**
 * The parts of a distance [m].
 * @param {number[]} a
 * @param {number[]} b
 */
export function distanceParts(a, b) {
  const d = minus(b, a);
  return { length: lengthOf(d), horizontal: Math.hypot(d[0], d[1]), vertical: d[2] };
}

/** The angle at the second of three points [°]. */
export function angleOf(/** @type {number[][]} */ [a, corner, b]) {
  const [u, v] = [minus(a, corner), minus(b, corner)];
  const cosine = dot(u, v) / (lengthOf(u) * lengthOf(v));
  return (Math.acos(Math.min(1, Math.max(-1, cosine))) * 180) / Math.PI;
}

/** The area of a polygon in space, on its mean plane, and its perimeter [m², m]. */
export function areaOf(/** @type {number[][]} */ points) {
  let normal = [0, 0, 0];
  let perimeter = 0;
  points.forEach((p, k) => {
    const next = points[(k + 1) % points.length];
    const [u, v] = [minus(p, points[0]), minus(next, points[0])];
    normal = add(normal, [
      u[1] * v[2] - u[2] * v[1],
      u[2] * v[0] - u[0] * v[2],
      u[0] * v[1] - u[1] * v[0],
    ]);
    perimeter += lengthOf(minus(next, p));
  });
  return { area: lengthOf(normal) / 2, perimeter, plan: Math.abs(normal[2]) / 2 };
}

/** Standard deviation of a distance by those of its ends [m]; NaN if they are not stated. */
const sdOf = (/** @type {Measurement} */ { sd }) =>
  sd?.length === 2 ? Math.hypot(sd[0], sd[1]) : NaN;

/**
 * What a measurement says, as the figure and its parts.
 * @param {Measurement} measurement
 * @param {MapVolume | null} [volume] of a volume, when the server has computed it
 */
export function resultOf(measurement, volume = null) {
  const { kind, points } = measurement;
  if (kind === "volume") return volumeText(volume);
  if (kind === "point") return { value: points[0].map((x) => decimal(x, 3)).join(" "), parts: "" };
  if (kind === "angle") return { value: `${decimal(angleOf(points), 2)}°`, parts: "" };
  if (kind === "area") {
    const { area, perimeter, plan } = areaOf(points);
    const parts = t("area-parts", { plan, perimeter: meters(perimeter) });
    return { value: `${decimal(area, 3)} m²`, parts };
  }
  const { length, horizontal, vertical } = distanceParts(points[0], points[1]);
  if (kind === "profile") {
    const width = meters(measurement.figure ?? PROFILE_M);
    const parts = t("profile-parts", { width, apart: meters(vertical) });
    return { value: meters(horizontal), parts };
  }
  const sd = sdOf(measurement);
  const known = Number.isFinite(sd) ? `, σ ${decimal(1000 * sd, 1)} mm` : "";
  if (kind === "height")
    return {
      value: meters(vertical),
      parts: t("height-parts", { horizontal: meters(horizontal) }) + known,
    };
  const given = { horizontal: meters(horizontal), vertical: meters(vertical) };
  const parts = t("distance-parts", given) + known;
  return { value: meters(length), parts };
}

function volumeText(/** @type {MapVolume | null} */ found) {
  if (!found) return { value: "…", parts: "" };
  const cubic = (/** @type {number} */ m3) => `${decimal(m3, Math.abs(m3) < 10 ? 3 : 2)} m³`;
  const { above_m3, below_m3, sd_m3, area_m2, unseen_m2, base_m, fitted, cell_m } = found;
  const at = t("volume-base", { base: meters(base_m) });
  const parts = [
    t("volume-below", { below: cubic(below_m3), sd: cubic(sd_m3) }),
    t("volume-area", { area: area_m2, unseen: unseen_m2 }),
    fitted < 1 ? t("volume-fitted", { base: meters(base_m), percent: 100 * fitted }) : at,
    t("volume-cells", { cm: 100 * cell_m }),
  ];
  return { value: t("volume-above", { above: cubic(above_m3) }), parts: parts.join(", ") };
}

/** A cell of a CSV file; a spreadsheet does not take a name for a formula. */
function cell(/** @type {string} */ text) {
  const safe = /^[=+@\t\r-]/.test(text) ? `'${text}` : text;
  return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

const FIGURES = [
  ...["length_m", "horizontal_m", "vertical_m", "sd_m", "angle_deg", "area_m2"],
  ...["width_m", "above_m3", "below_m3", "sd_m3"],
];

/**
 * @param {Measurement} measurement
 * @param {MapVolume | null} volume
 * @returns {Record<string, number>}
 */
function figuresOf(measurement, volume) {
  const { kind, points } = measurement;
  if (kind === "volume") {
    const { above_m3, below_m3, sd_m3 } = volume ?? VOLUME;
    return { above_m3, below_m3, sd_m3 };
  }
  if (kind === "angle") return { angle_deg: angleOf(points) };
  if (kind === "area") return { area_m2: areaOf(points).area };
  if (kind === "point") return {};
  const { length, horizontal, vertical } = distanceParts(points[0], points[1]);
  if (kind === "profile") {
    const width_m = measurement.figure ?? PROFILE_M;
    return { horizontal_m: horizontal, vertical_m: vertical, width_m };
  }
  return {
    length_m: length,
    horizontal_m: horizontal,
    vertical_m: vertical,
    sd_m: sdOf(measurement),
  };
}

/**
 * All measurements as CSV: a row for each point, the figures in the first one of each.
 * @param {Measurement[]} measurements
 * @param {PointsInCrs | null} there all their points in the map's CRS; null = it has none
 * @param {(one: Measurement) => MapVolume | null} [volumeOf] of a volume
 */
export function toCsv(measurements, there, volumeOf = () => null) {
  const columns = ["x_m", "y_m", "z_m", ...(there ? ["crs", "e", "n", "h"] : [])];
  const head = ["name", "kind", "point", ...columns, "snapped_to", ...FIGURES];
  const places = there?.p_crs.values();
  const rows = measurements.flatMap((one) =>
    one.points.map((p, k) => {
      const figures = k ? {} : figuresOf(one, volumeOf(one));
      const at = places?.next().value ?? [];
      return [
        cell(one.name),
        one.kind,
        k + 1,
        ...p.map((x) => x.toFixed(4)),
        ...(there ? [there.crs, ...at.map((x) => x.toFixed(4))] : []),
        one.snaps?.[k] ?? "",
        ...FIGURES.map((name) => {
          const value = /** @type {Record<string, number>} */ (figures)[name];
          return value === undefined || Number.isNaN(value) ? "" : value.toFixed(4);
        }),
      ].join(",");
    }),
  );
  return [head.join(","), ...rows, ""].join("\r\n");
}
