// The figures of a run's summary a person looks at first. No DOM, no network.

import { count, seconds } from "./format.js";

const metres = (m, digits) => `${m.toFixed(digits)} m`;

/** [words, value] rows; figures the run did not make are left out. */
export function figures(summary) {
  return [];
}

/** The few words under a project's name. */
export function headline(summary) {
  return figures(summary).slice(0, 2).map(([, value]) => value);
}
