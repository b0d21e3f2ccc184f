// The calibration dance as texts: what to do next, and which axes the walk has shown. No elements.

import { t } from "../shared/texts.js";

/** @import {Loop, Motion} from "./messages" */

const STILL_S = 3;
const TILT_DEG = 25; // from one side to the other
const TURN_DEG = 360;
const LOOP_M = 15;
const BACK_M = 2;
const QUANTITIES = ["rotation", "position", "clock"];
const NOTHING = { still_s: 0, tilt_deg: [0, 0], turned_deg: [0, 0] };

/**
 * The four steps: [{name, text, done, now}]; `now` is what was reached.
 * @param {Omit<Motion, "axes"> | null | undefined} motion
 * @param {Pick<Loop, "walked_m" | "start_m"> | null | undefined} loop
 */
export function steps(motion, loop) {
  const { still_s: still, tilt_deg: tilt, turned_deg: turned } = motion ?? NOTHING;
  const walked = loop?.walked_m ?? 0;
  const away = loop?.start_m ?? 0;
  return [
    {
      name: t("dance-still"),
      text: t("dance-still-text", { seconds: String(STILL_S) }),
      done: still >= STILL_S,
      now: t("dance-seconds", { seconds: still.toFixed(0) }),
    },
    {
      name: t("dance-tilt"),
      text: t("dance-tilt-text"),
      done: Math.min(...tilt) >= TILT_DEG,
      now: degrees(tilt, TILT_DEG),
    },
    {
      name: t("dance-turn"),
      text: t("dance-turn-text"),
      done: Math.min(...turned) >= TURN_DEG,
      now: degrees(turned, TURN_DEG),
    },
    {
      name: t("dance-loop"),
      text: t("dance-loop-text", { m: String(LOOP_M) }),
      done: walked >= LOOP_M && away <= BACK_M,
      now: t("dance-loop-now", { walked: walked.toFixed(0), away: away.toFixed(0) }),
    },
  ];
}

/**
 * @param {number[]} values of both sides
 * @param {number} most
 */
const degrees = ([one = 0, other = 0], most) =>
  t("dance-degrees", { one: one.toFixed(0), other: other.toFixed(0), most: String(most) });

/** Rows of the table: [quantity, …texts of x, y, z]; a clock has one text. */
export function axisRows(/** @type {Motion | null | undefined} */ motion) {
  const axes = motion?.axes ?? [];
  return QUANTITIES.map((quantity) => [
    t(`dance-${quantity}`),
    ...axes.filter((one) => one.quantity === quantity).map(({ shown }) => shownText(shown)),
  ]).filter((row) => row.length > 1);
}

const shownText = (/** @type {number} */ ratio) =>
  ratio >= 1 ? t("dance-observed") : `${Math.floor(100 * ratio)} %`;

/**
 * What to do next, in a sentence.
 * @param {Motion | null | undefined} motion
 * @param {Loop | null | undefined} loop
 */
export function next(motion, loop) {
  if (!motion) return t("hint-still");
  const open = steps(motion, loop).find((one) => !one.done);
  if (open) return open.text;
  const missing = motion.axes.filter(({ shown }) => shown < 1);
  if (!missing.length) return t("dance-all");
  return t("dance-again");
}
