// Numbers and states as text. No DOM, no network.

/**
 * @import {JobView} from "./http_types"
 * @typedef {"queued" | "running" | "succeeded" | "failed" | "cancelled" | "finished" | "check" |
 *   "unusable" | "sound" | "unjudged" | "unfinished"} StateName of a project or job
 * @typedef {object} ProjectState what of a project makes its state
 * @property {boolean} finished
 * @property {string} [usability]
 * @property {Record<string, any>} [summary]
 * @typedef {Pick<import("./http_types").JobStatus,
 *   "done" | "unit" | "rate_per_s" | "eta_s">} Progress
 */

const NARROW = "\u202f";

export const count = (/** @type {number} */ n) =>
  Math.round(n)
    .toString()
    .replace(/\B(?=(\d{3})+$)/g, NARROW);

export function bytes(/** @type {number} */ n) {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let k = 0;
  while (n >= 1000 && k < units.length - 1) [n, k] = [n / 1000, k + 1];
  return `${k && n < 10 ? n.toFixed(1) : Math.round(n)} ${units[k]}`;
}

export function seconds(/** @type {number} */ s) {
  if (s < 9.95) return `${s.toFixed(1)} s`;
  const whole = Math.round(s);
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  const minutes = Math.round(s / 60);
  return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

export const when = (/** @type {string} */ iso) =>
  new Date(iso).toLocaleString("en-GB", { dateStyle: "medium", timeStyle: "short" });

/** @type {Record<StateName, {mark: string, word: string}>} */
export const STATES = {
  queued: { mark: "◷", word: "Waiting" },
  running: { mark: "▶", word: "Running" },
  succeeded: { mark: "✓", word: "Finished" },
  failed: { mark: "✕", word: "Failed" },
  cancelled: { mark: "■", word: "Cancelled" },
  finished: { mark: "✓", word: "Finished" },
  check: { mark: "▲", word: "Check this map" },
  unusable: { mark: "✕", word: "Do not use this map" },
  sound: { mark: "✓", word: "No problem found in this map" },
  unjudged: { mark: "▲", word: "No verdict on this map" },
  unfinished: { mark: "◌", word: "Not finished" },
};

/** Verdict -> state of a finished project. */
/** @type {Record<string, StateName>} */
const VERDICTS = { good: "sound", check: "check", "do not use": "unusable" };

/**
 * State of a project: that of its unfinished job, else the verdict on its map, else its folder.
 * @param {ProjectState | null | undefined} project
 * @param {JobView | null | undefined} view
 */
export function stateOf(project, view) {
  const state = view?.job.state;
  if (state && state !== "succeeded") return state;
  const verdict = VERDICTS[project?.usability ?? project?.summary?.verdict?.usability];
  if (verdict) return verdict;
  return project?.finished || state === "succeeded" ? "finished" : "unfinished";
}

/** A remaining time; near its end an estimate of parts of a second would promise too much. */
const timeLeft = (/** @type {number} */ s, about = "") =>
  s < 1 ? "nearly done" : `${about}${seconds(s)} left`;

/** Progress of the whole run and its remaining time. */
export function runProgressText(
  /** @type {Pick<JobView, "run_progress" | "run_eta_s"> & {status: {what: string}}} */ {
    run_progress,
    run_eta_s,
    status,
  },
) {
  if (!status.what) return "Starting";
  const left = run_eta_s === null ? [] : [timeLeft(run_eta_s, "about ")];
  return [`${Math.round(run_progress * 100)} % of the run`, ...left].join(" · ");
}

/** Progress of the current stage in one line: fraction, rate, remaining time. */
export function progressText(
  /** @type {Pick<JobView, "fraction"> & {status: Progress}} */ { status, fraction },
) {
  const parts = [
    fraction === null ? `${count(status.done)} ${status.unit}` : `${Math.round(fraction * 100)} %`,
  ];
  if (status.rate_per_s > 0) {
    const rate = status.rate_per_s;
    parts.push(`${rate < 10 ? rate.toFixed(1) : count(rate)} ${status.unit}/s`);
  }
  if (status.eta_s !== null) parts.push(timeLeft(status.eta_s));
  return `This part ${parts.join(" · ")}`;
}

/** A part of a whole in percent, where nothing would look like none at all. */
export const shareText = (/** @type {number} */ percent) =>
  percent < 0.1 ? "below 0.1 %" : `${percent.toFixed(1)} %`;
