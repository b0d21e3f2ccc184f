// The work of several people on a pair, in words. No DOM, no network.

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

const verdict = (/** @type {boolean} */ accepted) => (accepted ? "accepted" : "rejected");
const listed = (/** @type {string[]} */ names) =>
  names.length < 2 ? names.join("") : `${names.slice(0, -1).join(", ")} and ${names.at(-1)}`;

/** What the people who decided say together; empty if nobody did and nobody is asked to. */
export function agreementText(/** @type {Opinions} */ { opinions, agreement, second_by, waits }) {
  const [first] = opinions;
  if (agreement === "agree" && first)
    return `✓ ${listed(opinions.map(({ who }) => who))} agree: ${verdict(first.accepted)}`;
  if (agreement === "disagree")
    return `▲ ${opinions.map(({ who, accepted }) => `${who} ${verdict(accepted)}`).join(", ")}`;
  if (!waits) return first ? `${first.who} ${verdict(first.accepted)} it` : "";
  return first
    ? `◌ ${first.who} ${verdict(first.accepted)} it; ${second_by} asked for a second opinion`
    : `◌ ${second_by} asked for two opinions`;
}

/** The work on a pair in the few letters of a row of the queue. */
export function workMark(/** @type {Partial<WorkView> | undefined} */ work) {
  if (!work) return "";
  return [
    work.assignee && `→ ${work.assignee}`,
    work.skipped_by && "later",
    work.waits && "second opinion",
    work.agreement === "disagree" && "▲ disagree",
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
  if (!lookers.length) return "Nobody else is looking now";
  const texts = lookers.map(({ who, frame_i, frame_j }) => {
    if (frame_i === null) return who;
    const same = pair && frame_i === pair[0] && frame_j === pair[1];
    return same ? `${who} (at this pair)` : `${who} (multiframes ${frame_i} and ${frame_j})`;
  });
  return `Now here: ${texts.join(", ")}`;
}
