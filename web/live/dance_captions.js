// The calibration dance as texts: what to do next, and which axes the walk has shown. No elements.

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
      name: "Still",
      text: `Stand still for ${STILL_S} s`,
      done: still >= STILL_S,
      now: `${still.toFixed(0)} s`,
    },
    {
      name: "Tilt",
      text: "Bend forward and back, then to both sides",
      done: Math.min(...tilt) >= TILT_DEG,
      now: `${degrees(tilt)} of ${TILT_DEG}°`,
    },
    {
      name: "Turn",
      text: "Turn around once to the left and once to the right",
      done: Math.min(...turned) >= TURN_DEG,
      now: `${degrees(turned)} of ${TURN_DEG}°`,
    },
    {
      name: "Loop",
      text: `Walk a loop of ${LOOP_M} m and come back`,
      done: walked >= LOOP_M && away <= BACK_M,
      now: `${walked.toFixed(0)} m, ${away.toFixed(0)} m from the start`,
    },
  ];
}

const degrees = (/** @type {number[]} */ values) =>
  values.map((value) => `${value.toFixed(0)}°`).join(" and ");

/** Rows of the table: [quantity, …texts of x, y, z]; a clock has one text. */
export function axisRows(/** @type {Motion | null | undefined} */ motion) {
  const axes = motion?.axes ?? [];
  return QUANTITIES.map((quantity) => [
    quantity,
    ...axes.filter((one) => one.quantity === quantity).map(({ shown }) => shownText(shown)),
  ]).filter((row) => row.length > 1);
}

const shownText = (/** @type {number} */ ratio) =>
  ratio >= 1 ? "✓ observed" : `${Math.floor(100 * ratio)} %`;

/**
 * What to do next, in a sentence.
 * @param {Motion | null | undefined} motion
 * @param {Loop | null | undefined} loop
 */
export function next(motion, loop) {
  if (!motion) return "Stand still: the map starts in a few seconds";
  const open = steps(motion, loop).find((one) => !one.done);
  if (open) return open.text;
  const missing = motion.axes.filter(({ shown }) => shown < 1);
  if (!missing.length) return "✓ Every axis is observed: stop now";
  return "Bend and turn again, faster: some axes are not observed yet";
}
