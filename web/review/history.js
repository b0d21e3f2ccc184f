// The history of the verdicts on a pair, in words. No DOM, no network.

import { t } from "../shared/texts.js";
import { length, percent, plain, reasonText } from "./captions.js";

/**
 * @import {Judgment} from "../shared/http_types"
 * @import {Row} from "./state.js"
 * @typedef {{by: string, verdict: string, why: string, pending?: boolean}} Verdicts one of a pair
 * @typedef {Pick<Row, "who" | "why" | "state">} InForce the decision in force
 */

/**
 * The figure that a judge compared with its limit: the name of its text, and how it is written.
 * @type {Record<string, [string, (value: number) => string]>}
 */
const MEASURES = {
  overlap: ["measure-overlap", percent],
  error_m: ["measure-error-m", length],
  match_ratio: ["measure-match-ratio", percent],
  degeneracy: ["measure-degeneracy", plain],
  seen_through: ["measure-seen-through", (v) => `${plain(100 * v, 2)} %`],
  confirmed_nodes: ["measure-confirmed-nodes", plain],
  contradicted_nodes: ["measure-contradicted-nodes", plain],
  verification_m: ["measure-verification-m", length],
  chi2: ["measure-chi2", plain],
};

/** The figure of a judgment with its limit; empty if it has none. */
export function figureText(
  /** @type {Pick<Judgment, "measure" | "value" | "limit">} */ { measure, value, limit },
) {
  if (!measure || value === null) return "";
  const [id, write] = MEASURES[measure] ?? [measure, plain];
  const figure = `${t(id)} ${write(value)}`;
  return limit === null ? figure : t("with-limit", { figure, limit: write(limit) });
}

/** One verdict: `by` whom, `verdict`, and `why` with the figure that decided. */
export function judgmentText(/** @type {Judgment} */ judgment) {
  const { by, person, verdict, reason, measure, value, note } = judgment;
  const alone = by === "verification" && measure && value === null;
  const figure = alone ? t("no-alternative-path") : figureText(judgment);
  const why = person ? note : [reasonText(reason), figure].filter(Boolean).join("; ");
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
