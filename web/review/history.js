// The history of the verdicts on a pair, in words. No DOM, no network.

import { length, percent, plain } from "./captions.js";

/**
 * @import {Judgment} from "../shared/http_types"
 * @import {Row} from "./state.js"
 * @typedef {{by: string, verdict: string, why: string, pending?: boolean}} Verdicts one of a pair
 * @typedef {Pick<Row, "who" | "why" | "state">} InForce the decision in force
 */

/**
 * The figure that a judge compared with its limit: in words, and how it is written.
 * @type {Record<string, [string, (value: number) => string]>}
 */
const MEASURES = {
  overlap: ["overlap", percent],
  error_m: ["error", length],
  match_ratio: ["matches", percent],
  degeneracy: ["degeneracy", plain],
  seen_through: ["seen through", (v) => `${plain(100 * v, 2)} %`],
  confirmed_nodes: ["nodes that confirm it", plain],
  contradicted_nodes: ["nodes that contradict it", plain],
  verification_m: ["path discrepancy", length],
  chi2: ["squared residual", plain],
};

/** The figure of a judgment with its limit; empty if it has none. */
export function figureText(
  /** @type {Pick<Judgment, "measure" | "value" | "limit">} */ { measure, value, limit },
) {
  if (!measure || value === null) return "";
  const [word, write] = MEASURES[measure] ?? [measure, plain];
  return `${word} ${write(value)}${limit === null ? "" : `, limit ${write(limit)}`}`;
}

/** One verdict: `by` whom, `verdict`, and `why` with the figure that decided. */
export function judgmentText(/** @type {Judgment} */ judgment) {
  const { by, person, verdict, reason, measure, value, note } = judgment;
  const alone = by === "verification" && measure && value === null;
  const figure = alone ? "no alternative path" : figureText(judgment);
  const why = person ? note : [reason, figure].filter(Boolean).join("; ");
  return { by: person || by, verdict, why };
}

/**
 * What people decided since the map was made; null if the history has it.
 * @param {Judgment | undefined} last
 * @param {InForce} given
 */
function undecidedYet(last, { who, why, state }) {
  if (who)
    return last?.person === who && last.verdict === state && last.note === why
      ? null
      : { by: who, verdict: state, why, pending: true };
  return last?.person
    ? { by: "people", verdict: "left to the program", why: "", pending: true }
    : null;
}

/**
 * All verdicts on a pair, oldest first: those in the map, then the decision not in it yet.
 * `row` has the decision in force: `who`, `why` and `state`.
 * @param {Judgment[]} history
 * @param {InForce} row
 */
export function historyOf(history, row) {
  const pending = undecidedYet(history.at(-1), row);
  return [...history.map(judgmentText), ...(pending ? [pending] : [])];
}
