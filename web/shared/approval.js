// The approval of a map in one line, the same on every page. No DOM, no network.

/** @import {ApprovalState} from "./http_types" */

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
  /** @type {Pick<ApprovalState, "kind" | "text" | "checking">} */ { kind, text, checking },
) {
  const [mark, level] = LEVELS[kind];
  if (!checking) return { text: `${mark} ${text}`, level };
  return { text: `◷ ${text}; its bytes are being compared with the signature`, level: "" };
}

/** Whether the files carry an approval that does not count. */
export const isRefused = (/** @type {Pick<ApprovalState, "kind">} */ { kind }) =>
  kind === "unknown signer" || kind === "not valid";

/** The verdict that a map was approved in spite of, with the signer's reason. */
export const inSpiteOf = (
  /** @type {Pick<ApprovalState, "verdict" | "why">} */ { verdict, why },
) =>
  !verdict || verdict === "good"
    ? ""
    : `, in spite of the verdict “${verdict}”${why ? `: “${why}”` : ""}`;
