// The approval of a map as elements: one line, and why it does not count.

import { approvalLine } from "./approval.js";
import { make } from "./dom.js";

/** The line alone. */
export function approvalMark(approval) {
  const { text, level } = approvalLine(approval);
  return make("p", { className: `approval ${level}` }, text);
}

/** The line within a row of facts. */
export function approvalFact(approval) {
  const { text, level } = approvalLine(approval);
  return make("span", { className: level, title: approval.detail }, text);
}

/** The line, and what to do. */
export const approvalLines = (approval) => [
  approvalMark(approval),
  approval.detail ? make("p", { className: "quiet approval-detail" }, approval.detail) : null,
];
