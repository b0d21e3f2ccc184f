// The approval of a map in one line, the same on every page. No DOM, no network.

import { t, wordOf } from "./texts.js";

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
  /** @type {Pick<ApprovalState, "kind" | "text" | "checking">} */ state,
) {
  const { kind, checking } = state;
  const [mark, level] = LEVELS[kind];
  const text = approvalWords(state);
  if (!checking) return { text: `${mark} ${text}`, level };
  return { text: `◷ ${t("approval-checking", { text })}`, level: "" };
}

/** The line of the server in the language of the page. */
export function approvalWords(/** @type {Pick<ApprovalState, "text">} */ { text }) {
  const found = text.match(/^Approved v(\d+) · (.*) · (\d{4}-\d\d-\d\d)(.*)$/);
  if (!found) return phrase(text);
  const [, version = "", who = "", day = "", more = ""] = found;
  return t("approval-signed", { version, who, day }) + phrase(more);
}

/** A part of the line of the server, which may name a version or a key. */
function phrase(/** @type {string} */ text) {
  const version = text.match(/(?<=version )\d+/)?.[0] ?? "";
  const key = text.match(/(?<=unknown key )\S+(?=:)/)?.[0] ?? "";
  const named = text.replace(version, "").replace(key, "");
  const words = wordOf("approval", named, { version, key });
  return words === named ? text : words;
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
    : t("in-spite-of", { verdict: wordOf("usability", verdict) }) + (why ? `: “${why}”` : "");
