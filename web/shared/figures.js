// The main figures of a run's summary. No DOM, no network.

import { bytes, count, seconds } from "./format.js";
import { asWritten, decimal, t } from "./texts.js";

/** @import {ProjectCard} from "./http_types" */

/** Date, age and accuracy of a calibration as text. */
function calibrated(/** @type {any} */ { calibration, age_days: days, max_age_days: most }) {
  if (!calibration) return t("calibrated-unknown");
  const { date, method, sd_deg: deg, sd_mm: mm, sd_ms: ms } = calibration;
  const known = [
    deg && `${asWritten(deg)}°`,
    mm && `${asWritten(mm)} mm`,
    ms && `${asWritten(ms)} ms`,
  ].filter(Boolean);
  const aged = days > most ? "calibrated-age-old" : "calibrated-age";
  const age = days === null ? "" : t(aged, { days: String(days) });
  return `${t("calibrated-by", { date, method })}${age}${
    known.length ? `; σ ${known.join(", ")}` : ""
  }`;
}

const serials = (/** @type {{sensors: Array<{name: string, serial: string}>}} */ { sensors }) =>
  sensors.map(({ name, serial }) => `${name} ${serial || t("not-known")}`).join(", ");

/** @type {Array<[string, string, (value: any) => string]>} */
const ROWS = [
  [t("figure-path"), "path_length_m", (m) => `${decimal(m, 1)} m`],
  [t("figure-points"), "points", count],
  [t("figure-duration"), "duration_s", seconds],
  [t("figure-multiframes"), "multiframes", count],
  [t("figure-lost"), "lost", count],
  [t("figure-accepted"), "edges", (edges) => count(edges.accepted ?? 0)],
  [t("figure-rejected"), "edges", (edges) => count(edges.rejected ?? 0)],
  [t("figure-unverified"), "edges", (edges) => count(edges.unverified ?? 0)],
  [t("figure-rig"), "rig_origin", ({ name }) => name],
  [t("figure-serials"), "rig_origin", serials],
  [t("figure-calibrated"), "rig_origin", calibrated],
  [t("figure-time"), "seconds", seconds],
  [t("figure-memory"), "peak_bytes", bytes],
];

/** [caption, value] rows; figures that are missing are left out. */
export const figures = (/** @type {Record<string, any>} */ summary) =>
  ROWS.filter(([, key]) => summary[key] !== undefined && summary[key] !== null).map(
    ([text, key, format]) => [text, format(summary[key])],
  );

/** The caption below a project's name. */
export function headline(/** @type {Partial<ProjectCard>} */ summary) {
  if (summary.path_length_m == null) return [];
  const path = t("headline-path", { m: summary.path_length_m.toFixed(0) });
  const points = summary.points;
  return [path, points ? t("headline-points", { points }) : t("headline-2d")];
}
