// Captions and units of the review page, and its keys. No DOM, no network.

import { approvalLine, inSpiteOf } from "../shared/approval.js";
import { hasText, t, written } from "../shared/texts.js";

/** @import {ApprovalState, ReviewView} from "../shared/http_types" */

/**
 * `word` is the name of its text.
 * @type {Record<string, {mark: string, word: string}>}
 */
export const VERDICTS = {
  accepted: { mark: "✓", word: "mark-accepted" },
  rejected: { mark: "✕", word: "mark-rejected" },
  unverified: { mark: "◌", word: "mark-unverified" },
};

/**
 * Words for values as the server stores them: a value and the name of its text.
 * @param {Record<string, string>} texts
 */
const wordsFor = (texts) => (/** @type {string} */ value) => {
  const id = texts[value];
  return id ? t(id) : value;
};

/** What a row of the journal did; the texts quote the pair. @type {Record<string, string>} */
export const KINDS = {
  accept: "did-accept",
  reject: "did-reject",
  restore: "did-restore",
  replace: "did-replace",
  add: "did-add",
  undo: "did-undo",
  redo: "did-redo",
  approve: "did-approve",
  acknowledge: "did-acknowledge",
  control: "did-control",
  classify: "did-classify",
  withdraw: "did-withdraw",
  assign: "did-assign",
  comment: "did-comment",
  skip: "did-skip",
  second: "did-second",
  waive: "did-waive",
};

/** Why an edge was rejected. */
export const reasonText = wordsFor({
  "overlap < t_o": "reason-overlap",
  "error > limit": "reason-error",
  "not converged": "reason-not-converged",
  "too few segments match": "reason-few-matches",
  degenerate: "reason-degenerate",
  "free space contradicts it": "reason-seen-through",
  "neighboring places do not confirm it": "reason-unconfirmed",
  "ambiguous: places look alike": "reason-ambiguous",
  "verification median > limit": "reason-verification",
  "outlier in the robust solution": "reason-robust",
  operator: "reason-operator",
});

/** Who judged an edge, if it was no person. */
export const judgeText = wordsFor({
  odometry: "judge-odometry",
  search: "judge-search",
  "free space": "judge-free-space",
  "neighboring places": "judge-neighboring-places",
  verification: "judge-verification",
  "robust solve": "judge-robust-solve",
  GNSS: "judge-gnss",
  person: "judge-person",
  people: "judge-people",
  program: "judge-program",
});

/** A verdict within a sentence. */
export const verdictText = wordsFor({
  accepted: "verdict-accepted",
  rejected: "verdict-rejected",
  unverified: "verdict-unverified",
  "left to the program": "verdict-left-to-the-program",
});

/** Where an edge comes from. */
export const edgeText = wordsFor({
  loop: "edge-loop",
  neighbor: "edge-neighbor",
  manual: "edge-manual",
  odometry: "edge-odometry",
});

/** Of each key its name, or that of its text, and the text of what it does. */
const KEYS = [
  ["J", "do-next"],
  ["K", "do-previous"],
  ["A", "do-accept"],
  ["R", "do-reject"],
  ["S", "do-skip"],
  ["key-restore", "do-restore"],
  ["key-undo", "do-undo"],
  ["key-redo", "do-redo"],
  ["key-move", "do-move"],
  ["key-turn", "do-turn"],
  ["key-lift", "do-lift"],
  ["P", "do-pick"],
  ["key-refine", "do-refine"],
  ["key-drop", "do-drop"],
  ["L", "do-add"],
  ["V", "do-view"],
  ["B", "do-compare"],
  ["D", "do-difference"],
  ["key-cut", "do-cut"],
  ["key-zoom", "do-zoom"],
  ["W", "do-reason"],
  ["?", "do-help"],
  ["key-held", "do-held"],
];

/** What each key does; the help sheet is made of this. @returns {Array<[string, string]>} */
export const keys = () => KEYS.map(([key, text]) => [hasText(key) ? t(key) : key, t(text)]);

export const seconds = (/** @type {number} */ s) =>
  s < 60
    ? written(`${s.toFixed(1)} s`)
    : `${Math.floor(s / 60)}:${(s % 60).toFixed(0).padStart(2, "0")} min`;

export function length(/** @type {number | null | undefined} */ m) {
  if (m === null || m === undefined) return "–";
  if (m < 0.0995) return written(`${(m * 1000).toFixed(m < 0.00995 ? 1 : 0)} mm`);
  return m < 0.995 ? `${(m * 100).toFixed(0)} cm` : written(`${m.toFixed(2)} m`);
}

export const degrees = (/** @type {number} */ rad, digits = 1) =>
  written(`${((rad * 180) / Math.PI).toFixed(digits)}°`);
export const percent = (/** @type {number | null | undefined} */ v) =>
  v === null || v === undefined ? "–" : `${Math.round(v * 100)} %`;
export const plain = (/** @type {number | null | undefined} */ v, digits = 3) =>
  v === null || v === undefined ? "–" : written(Number(v.toPrecision(digits)).toString());
export const keyOf = (/** @type {number[]} */ [i, j]) => `${i}-${j}`;

const CONTRADICTED = "verification median > limit"; // a reason as the server stores it

/**
 * How the program or a person came to the edge, with the figure that decided it.
 * @param {Pick<import("./state.js").Row, "kind" | "reason" | "verification_m">} row
 * @param {number} path_limit_m
 */
export function decisionText(row, path_limit_m) {
  if (row.kind === "manual") return t("created-by-person");
  if (!row.reason) return t("accepted-automatically");
  const reason =
    row.reason === CONTRADICTED && row.verification_m !== null
      ? t("path-discrepancy-over", {
          found: length(row.verification_m),
          limit: length(path_limit_m),
        })
      : reasonText(row.reason);
  return t("rejected-automatically", { reason });
}

/** Who approved which version, and in spite of which verdict. */
export const approvalText = (/** @type {ApprovalState} */ approval) =>
  approvalLine(approval).text + (approval.hash ? inSpiteOf(approval) : "");

/** Whether the map was made with the decisions in force. */
export function mapText(
  /** @type {Pick<ReviewView, "busy" | "finished" | "in_map" | "standing">} */ {
    busy,
    finished,
    in_map,
    standing: activeDecisions,
  },
) {
  if (busy) return t("job-runs-mark");
  if (!finished) return t("no-map-mark");
  if (!in_map) return t("not-in-map-mark");
  return activeDecisions.length ? t("made-with-decisions") : t("made-without-decisions");
}

export const permissionMissing = (/** @type {string} */ permission) =>
  t("permission-missing", { permission: t(permission) });

/** Why the map cannot be approved now; empty if it can. */
export function approvalObstacle(
  /**
   * @type {Pick<ReviewView,
   *   "busy" | "finished" | "in_map" | "may_review" | "approval" | "obstacle">}
   */ { busy, finished, in_map, may_review, approval, obstacle },
) {
  if (!may_review) return permissionMissing("may-review");
  if (busy) return t("job-runs");
  if (!finished) return t("no-map");
  if (!in_map) return t("not-in-map");
  if (obstacle) return obstacle;
  return ["approved", "earlier"].includes(approval.kind) ? t("map-is-approved") : "";
}
