// The approval of a map as elements: one line, and why it does not count.

import { approvalLine } from "./approval.js";
import { html } from "./dom.js";

/** @import {ApprovalState} from "./http_types" */

/** The line alone. */
export function approvalMark(/** @type {ApprovalState} */ approval) {
  const { text, level } = approvalLine(approval);
  return html`<p class="approval ${level}">${text}</p>`;
}

/** The line within a row of facts. */
export function approvalFact(/** @type {ApprovalState} */ approval) {
  const { text, level } = approvalLine(approval);
  return html`<span class=${level} title=${approval.detail}>${text}</span>`;
}

/** The line, and what to do. */
export const approvalLines = (/** @type {ApprovalState} */ approval) => [
  approvalMark(approval),
  approval.detail ? html`<p class="quiet approval-detail">${approval.detail}</p>` : null,
];
