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

import { decimal, locale, t, wordOf } from "./texts.js";

const NARROW = "\u202f";

export const count = (/** @type {number} */ n) =>
  Math.round(n)
    .toString()
    .replace(/\B(?=(\d{3})+$)/g, NARROW);

export function bytes(/** @type {number} */ n) {
  const units = ["B", "kB", "MB", "GB", "TB"];
  let k = 0;
  while (n >= 1000 && k < units.length - 1) [n, k] = [n / 1000, k + 1];
  return `${k && n < 10 ? decimal(n, 1) : Math.round(n)} ${units[k]}`;
}

export function seconds(/** @type {number} */ s) {
  if (s < 9.95) return `${decimal(s, 1)} s`;
  const whole = Math.round(s);
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  const minutes = Math.round(s / 60);
  return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

export const when = (/** @type {string} */ iso) =>
  new Date(iso).toLocaleString(locale(), { dateStyle: "medium", timeStyle: "short" });

/** @type {Record<StateName, {mark: string, word: string}>} */
export const STATES = {
  queued: { mark: "◷", word: t("state-queued") },
  running: { mark: "▶", word: t("state-running") },
  succeeded: { mark: "✓", word: t("state-succeeded") },
  failed: { mark: "✕", word: t("state-failed") },
  cancelled: { mark: "■", word: t("state-cancelled") },
  finished: { mark: "✓", word: t("state-finished") },
  check: { mark: "▲", word: t("state-check") },
  unusable: { mark: "✕", word: t("state-unusable") },
  sound: { mark: "✓", word: t("state-sound") },
  unjudged: { mark: "▲", word: t("state-unjudged") },
  unfinished: { mark: "◌", word: t("state-unfinished") },
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
const timeLeft = (/** @type {number} */ s, text = "time-left") =>
  s < 1 ? t("time-left-none") : t(text, { time: seconds(s) });

/** Progress of the whole run and its remaining time. */
export function runProgressText(
  /** @type {Pick<JobView, "run_progress" | "run_eta_s"> & {status: {what: string}}} */ {
    run_progress,
    run_eta_s,
    status,
  },
) {
  if (!status.what) return t("starting");
  const left = run_eta_s === null ? [] : [timeLeft(run_eta_s, "time-left-about")];
  const part = String(Math.round(run_progress * 100));
  return [t("run-part", { part }), ...left].join(" · ");
}

/** A number of units of work; bytes as a size. */
const amount = (
  /** @type {number} */ n,
  /** @type {string} */ written,
  /** @type {string} */ unit,
) => (unit === "B" ? bytes(n) : `${written} ${wordOf("unit", unit)}`);

/** Progress of the current stage in one line: fraction, rate, remaining time. */
export function progressText(
  /** @type {Pick<JobView, "fraction"> & {status: Progress}} */ { status, fraction },
) {
  const parts = [
    fraction === null
      ? amount(status.done, count(status.done), status.unit)
      : `${Math.round(fraction * 100)} %`,
  ];
  if (status.rate_per_s > 0) {
    const rate = status.rate_per_s;
    parts.push(`${amount(rate, rate < 10 ? decimal(rate, 1) : count(rate), status.unit)}/s`);
  }
  if (status.eta_s !== null) parts.push(timeLeft(status.eta_s));
  return t("this-part", { progress: parts.join(" · ") });
}

/** A part of a whole in percent, where nothing would look like none at all. */
export const shareText = (/** @type {number} */ percent) =>
  percent < 0.1 ? t("share-tiny", { least: decimal(0.1, 1) }) : `${decimal(percent, 1)} %`;
