// The audit of a rig as text. No DOM, no network.

import { decimal, t, wordOf } from "../shared/texts.js";

/** @import {CalibrationView, JobView, ParameterView} from "../shared/http_types" */

/** @typedef {{factor: number, unit: string, digits: number}} Unit */

/** @type {Record<ParameterView["unit"], Unit>} */
const UNITS = {
  rad: { factor: 180 / Math.PI, unit: "°", digits: 3 },
  m: { factor: 100, unit: " cm", digits: 2 },
  s: { factor: 1e3, unit: " ms", digits: 2 },
};
/** @type {Record<ParameterView["status"], {mark: string, word: string, className: string}>} */
const STATUS = {
  consistent: { mark: "✓", word: t("rig-agrees"), className: "good" },
  off: { mark: "✕", word: t("rig-differs"), className: "bad" },
  "not observable": { mark: "–", word: t("rig-not-observable"), className: "quiet" },
};
/** @type {Record<string, string>} */
const NAMES = { imu: t("rig-imu"), gnss: t("rig-gnss") };
const MODE = "calibration.mode=";

/** The rows of the table: texts, and the result as mark and word. */
export const rowsOf = (/** @type {ParameterView[]} */ parameters) =>
  parameters.map(({ sensor, quantity, axis, unit, change, sd, status }) => ({
    sensor: NAMES[sensor] ?? sensor,
    quantity: [wordOf("quantity", quantity), axis].filter(Boolean).join(" "),
    change: status === "not observable" && sd === null ? "–" : amount(change, sd, UNITS[unit]),
    ...STATUS[status],
  }));

/**
 * @param {number} change
 * @param {number | null} sd
 * @param {Unit} given
 */
function amount(change, sd, { factor, unit, digits }) {
  const value = change * factor;
  const sign = value < 0 ? "−" : "+";
  const text = `${sign}${decimal(Math.abs(value), digits)}`;
  return sd === null ? text + unit : `${text} ± ${decimal(sd * factor, digits)}${unit}`;
}

/** @type {Record<string, Unit>} */
const BEAM = {
  range: { factor: 1e3, unit: " mm", digits: 2 },
  elevation: { factor: 180 / Math.PI, unit: "°", digits: 4 },
  azimuth: { factor: 180 / Math.PI, unit: "°", digits: 4 },
};

/** A row for each beam: [LiDAR and ring, range, elevation, azimuth]. */
export function beamRows(/** @type {ParameterView[]} */ beams) {
  /** @type {Map<string, Record<string, string>>} */
  const rows = new Map();
  for (const { sensor, axis, quantity, change, sd, status } of beams) {
    const name = `${sensor} ${axis}`;
    const row = rows.get(name) ?? {};
    rows.set(name, row);
    const kind = quantity.replace("beam ", "");
    const unit = BEAM[kind];
    const known = sd !== null && status !== "not observable";
    row[kind] = known && unit ? amount(change, sd, unit) : t("rig-not-observable");
  }
  return [...rows].map(([name, of]) => [name, ...Object.keys(BEAM).map((kind) => of[kind] ?? "–")]);
}

/** The outcome in a word. */
export function outcomeOf(
  /** @type {Pick<CalibrationView, "parameters" | "applied">} */ { parameters, applied },
) {
  if (applied) return { mark: "✓", word: t("rig-used"), className: "good" };
  if (!parameters.length) return { mark: "–", word: t("rig-not-compared"), className: "quiet" };
  const off = parameters.some((one) => one.status === "off");
  if (off) return { mark: "✕", word: t("rig-file-differs"), className: "bad" };
  return { mark: "✓", word: t("rig-file-agrees"), className: "good" };
}

/**
 * The job that maps the recording again and calibrates its rig; null if no job is known.
 * @param {string} project
 * @param {JobView[]} views
 */
export function calibratingJob(project, views) {
  const job = views.map((view) => view.job).find((one) => one.inputs.recordings.length > 0);
  if (!job) return null;
  const { recordings, preset, rig, imu, gnss, settings } = job.inputs;
  const others = settings.filter((/** @type {string} */ text) => !text.startsWith(MODE));
  return { project, recordings, preset, rig, imu, gnss, settings: [...others, `${MODE}auto`] };
}
