// Captions and units of the review page, and its keys. No DOM, no network.

import { approvalLine, inSpiteOf } from "../shared/approval.js";

/** @import {ApprovalState, ReviewView} from "../shared/http_types" */

/** @type {Record<string, {mark: string, word: string}>} */
export const VERDICTS = {
  accepted: { mark: "✓", word: "Accepted" },
  rejected: { mark: "✕", word: "Rejected" },
  unverified: { mark: "◌", word: "Unverified" },
};

/** @type {Record<string, string>} */
export const KINDS = {
  accept: "accepted",
  reject: "rejected",
  restore: "restored the automatic decision on",
  replace: "registered again",
  add: "added",
  undo: "undid",
  redo: "redid",
  approve: "approved the map",
  acknowledge: "acknowledged a finding",
  control: "changed the control points",
  classify: "corrected classes of points",
  withdraw: "withdrew a correction of classes",
  assign: "assigned",
  comment: "commented on",
  skip: "left for later",
  second: "asked for a second opinion on",
  waive: "withdrew the question for a second opinion on",
};

/**
 * What each key does; the help sheet is made of this.
 * @type {Array<[string, string]>}
 */
export const KEYS = [
  ["J", "Next pair"],
  ["K", "Previous pair"],
  ["A", "Accept, once the points of this pair are drawn"],
  ["R", "Reject, once the points of this pair are drawn"],
  ["S", "Skip for later"],
  ["U or Backspace", "Restore the automatic decision"],
  ["Ctrl Z", "Undo"],
  ["Ctrl Y", "Redo"],
  ["Arrows", "Move the second place by 5 cm (Shift: 1 cm, Alt: 50 cm)"],
  [", and .", "Turn it by 1° (Shift: 0.1°, Alt: 10°)"],
  ["Page up, Page down", "Lift it, lower it"],
  ["P", "Pick the same three points in both places"],
  ["Enter", "Refine from here; once more: create the edge"],
  ["Escape", "Drop the new alignment"],
  ["L", "Add a loop closure between any two multiframes"],
  ["V", "Next view: above, side, free, cut"],
  ["B", "Compare: odometry, graph, aligned"],
  ["D", "Difference: in color only what one place has alone"],
  ["[ and ]", "Move the cut"],
  ["+ and −", "Zoom"],
  ["W", "Write a reason"],
  ["?", "This list"],
  [
    "A key held down",
    "Acts once, except for moving, turning, cut and zoom. " +
      "After a decision A and R act again once another pair is drawn",
  ],
];

export const seconds = (/** @type {number} */ s) =>
  s < 60
    ? `${s.toFixed(1)} s`
    : `${Math.floor(s / 60)}:${(s % 60).toFixed(0).padStart(2, "0")} min`;

export function length(/** @type {number | null | undefined} */ m) {
  if (m === null || m === undefined) return "–";
  if (m < 0.0995) return `${(m * 1000).toFixed(m < 0.00995 ? 1 : 0)} mm`;
  return m < 0.995 ? `${(m * 100).toFixed(0)} cm` : `${m.toFixed(2)} m`;
}

export const degrees = (/** @type {number} */ rad, digits = 1) =>
  `${((rad * 180) / Math.PI).toFixed(digits)}°`;
export const percent = (/** @type {number | null | undefined} */ v) =>
  v === null || v === undefined ? "–" : `${Math.round(v * 100)} %`;
export const plain = (/** @type {number | null | undefined} */ v, digits = 3) =>
  v === null || v === undefined ? "–" : Number(v.toPrecision(digits)).toString();
export const keyOf = (/** @type {number[]} */ [i, j]) => `${i}-${j}`;

const CONTRADICTED = "verification median > limit"; // a reason as the server stores it

/**
 * How the program or a person came to the edge, with the figure that decided it.
 * @param {Pick<import("./state.js").Row, "kind" | "reason" | "verification_m">} row
 * @param {number} path_limit_m
 */
export function decisionText(row, path_limit_m) {
  if (row.kind === "manual") return "Created by a person";
  if (!row.reason) return "Accepted automatically";
  const reason =
    row.reason === CONTRADICTED && row.verification_m !== null
      ? `path discrepancy ${length(row.verification_m)} > ${length(path_limit_m)}`
      : row.reason;
  return `Rejected automatically: ${reason}`;
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
  if (busy) return "▶ A job waits or runs";
  if (!finished) return "◌ There is no finished map yet";
  if (!in_map) return "◌ The last decisions are not in the map yet";
  return activeDecisions.length
    ? "✓ The map was made with these decisions"
    : "✓ The map was made without decisions of people";
}

export const permissionMissing = (/** @type {string} */ permission) =>
  `Requires the permission to ${permission}, which you do not have`;

/** Why the map cannot be approved now; empty if it can. */
export function approvalObstacle(
  /**
   * @type {Pick<ReviewView,
   *   "busy" | "finished" | "in_map" | "may_review" | "approval" | "obstacle">}
   */ { busy, finished, in_map, may_review, approval, obstacle },
) {
  if (!may_review) return permissionMissing("review");
  if (busy) return "A job waits or runs";
  if (!finished) return "There is no finished map yet";
  if (!in_map) return "The last decisions are not in the map";
  if (obstacle) return obstacle;
  return ["approved", "earlier"].includes(approval.kind) ? "This map is approved" : "";
}
