// The work of several people on a pair, in words. No DOM, no network.

import { t } from "../shared/texts.js";
/**
 * @import {LookerView, WorkView} from "../shared/http_types"
 * @typedef {Pick<WorkView, "opinions" | "agreement" | "second_by" | "waits">} Opinions
 */

/** What nobody did with a pair yet. @type {Omit<WorkView, "frame_i" | "frame_j">} */
export const NO_WORK = {
  assignee: "",
  skipped_by: "",
  second_by: "",
  comments: 0,
  opinions: [],
  agreement: "none",
  waits: false,
};

const verdict = (/** @type {boolean} */ accepted) =>
  t(accepted ? "verdict-accepted" : "verdict-rejected");
const said = (/** @type {WorkView["opinions"][number]} */ { who, accepted }) => ({
  who,
  verdict: verdict(accepted),
});
const listed = (/** @type {string[]} */ names) =>
  names.length < 2
    ? names.join("")
    : t("list-and", { all: names.slice(0, -1).join(", "), last: names.at(-1) ?? "" });

/** What the people who decided say together; empty if nobody did and nobody is asked to. */
export function agreementText(/** @type {Opinions} */ { opinions, agreement, second_by, waits }) {
  const [first] = opinions;
  if (agreement === "agree" && first)
    return t("agree", {
      names: listed(opinions.map(({ who }) => who)),
      verdict: verdict(first.accepted),
    });
  if (agreement === "disagree")
    return `▲ ${opinions.map((one) => t("one-said", said(one))).join(", ")}`;
  if (!waits) return first ? t("one-decided", said(first)) : "";
  return first
    ? t("asked-second", { ...said(first), asking: second_by })
    : t("asked-two", { asking: second_by });
}

/** The work on a pair in the few letters of a row of the queue. */
export function workMark(/** @type {Partial<WorkView> | undefined} */ work) {
  if (!work) return "";
  return [
    work.assignee && `→ ${work.assignee}`,
    work.skipped_by && t("later"),
    work.waits && t("second-opinion"),
    work.agreement === "disagree" && t("disagree"),
    work.comments && `✎ ${work.comments}`,
  ]
    .filter(Boolean)
    .join(" · ");
}

/**
 * Who else has the review open, and whether at this pair.
 * @param {LookerView[]} lookers
 * @param {[number, number] | undefined} pair
 */
export function lookersText(lookers, pair) {
  if (!lookers.length) return t("nobody-else");
  const texts = lookers.map(({ who, frame_i, frame_j }) => {
    if (frame_i === null) return who;
    const same = pair && frame_i === pair[0] && frame_j === pair[1];
    return same
      ? t("at-this-pair", { who })
      : t("at-pair", { who, i: String(frame_i), j: String(frame_j) });
  });
  return t("now-here", { people: texts.join(", ") });
}
