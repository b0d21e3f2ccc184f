// The main figures of a run's summary. No DOM, no network.

import { bytes, count, seconds } from "./format.js";

/** @import {ProjectCard} from "./http_types" */

/** Date, age and accuracy of a calibration as text. */
function calibrated(/** @type {any} */ { calibration, age_days: days, max_age_days: most }) {
  if (!calibration) return "not known: the rig file does not say";
  const { date, method, sd_deg: deg, sd_mm: mm, sd_ms: ms } = calibration;
  const known = [deg && `${deg}°`, mm && `${mm} mm`, ms && `${ms} ms`].filter(Boolean);
  const age = days === null ? "" : `, ${days} days before the walk${days > most ? " (old)" : ""}`;
  return `${date} by ${method}${age}${known.length ? `; σ ${known.join(", ")}` : ""}`;
}

const serials = (/** @type {{sensors: Array<{name: string, serial: string}>}} */ { sensors }) =>
  sensors.map(({ name, serial }) => `${name} ${serial || "not known"}`).join(", ");

/** @type {Array<[string, string, (value: any) => string]>} */
const ROWS = [
  ["Path length", "path_length_m", (m) => `${m.toFixed(1)} m`],
  ["Points in the map", "points", count],
  ["Duration of the walk", "duration_s", seconds],
  ["Multiframes", "multiframes", count],
  ["Multiframes, tracking lost", "lost", count],
  ["Edges accepted", "edges", (edges) => count(edges.accepted ?? 0)],
  ["Edges rejected", "edges", (edges) => count(edges.rejected ?? 0)],
  ["Edges unverified", "edges", (edges) => count(edges.unverified ?? 0)],
  ["Rig", "rig_origin", ({ name }) => name],
  ["Serial numbers", "rig_origin", serials],
  ["Rig calibrated", "rig_origin", calibrated],
  ["Processing time", "seconds", seconds],
  ["Peak memory", "peak_bytes", bytes],
];

/** [caption, value] rows; figures that are missing are left out. */
export const figures = (/** @type {Record<string, any>} */ summary) =>
  ROWS.filter(([, key]) => summary[key] !== undefined && summary[key] !== null).map(
    ([text, key, format]) => [text, format(summary[key])],
  );

/** The caption below a project's name. */
export function headline(/** @type {Partial<ProjectCard>} */ summary) {
  if (summary.path_length_m == null) return [];
  const path = `${summary.path_length_m.toFixed(0)} m path`;
  return summary.points ? [path, `${count(summary.points)} points`] : [path, "2-D map"];
}
