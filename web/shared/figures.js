// The main figures of a run's summary. No DOM, no network.

import { bytes, count, seconds } from "./format.js";

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
  ["Processing time", "seconds", seconds],
  ["Peak memory", "peak_bytes", bytes],
];

/** [caption, value] rows; figures that are missing are left out. */
export const figures = (summary) =>
  ROWS.filter(([, key]) => summary[key] !== undefined).map(([text, key, format]) => [
    text,
    format(summary[key]),
  ]);

/** The caption below a project's name. */
export function headline(summary) {
  if (summary.path_length_m == null) return [];
  return [`${summary.path_length_m.toFixed(0)} m path`, `${count(summary.points)} points`];
}
