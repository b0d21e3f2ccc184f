// The approval of a map in one line, the same on every page. No DOM, no network.

import { t, wordOf } from "./texts.js";

/** @import {ApprovalState, StoredText} from "./http_types" */

/** @type {Record<string, [string, string]>} */
const LEVELS = {
  draft: ["◌", "quiet"],
  approved: ["✓", "good"],
  earlier: ["▲", "warn"],
  changed: ["▲", "warn"],
  "unknown signer": ["✕", "bad"],
  "not valid": ["✕", "bad"],
};

/** Mark, line and CSS class; nothing is marked as approved while its bytes are being compared. */
export function approvalLine(
  /** @type {Pick<ApprovalState, "kind" | "text" | "code" | "values" | "checking">} */ state,
) {
  const { kind, checking } = state;
  const [mark, level] = LEVELS[kind];
  const text = approvalWords(state);
  if (!checking) return { text: `${mark} ${text}`, level };
  return { text: `◷ ${t("approval-checking", { text })}`, level: "" };
}

/** The line of an approval in the language of the page. */
export const approvalWords = (/** @type {StoredText} */ { text, code, values }) =>
  code ? t(code, values) : text;

/** Whether the files carry an approval that does not count. */
export const isRefused = (/** @type {Pick<ApprovalState, "kind">} */ { kind }) =>
  kind === "unknown signer" || kind === "not valid";

/** The verdict that a map was approved in spite of, with the signer's reason. */
export const inSpiteOf = (
  /** @type {Pick<ApprovalState, "verdict" | "why">} */ { verdict, why },
) =>
  !verdict || verdict === "good"
    ? ""
    : t("in-spite-of", { verdict: wordOf("usability", verdict) }) + (why ? `: “${why}”` : "");
