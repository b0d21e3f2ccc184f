// Texts of the operator's page, from the messages of the stream. No elements, no state.

/** @import {Battery, Fix, Gaps, Lidar, Message, Phone} from "./messages" */
/** @typedef {{text: string, error?: boolean, silent?: string}} Chip */

import { hasText, t } from "../shared/texts.js";

/** @type {Record<number, string>} */
const FIXES = { 1: "fix-single", 2: "fix-dgnss", 4: "fix-rtk-fixed", 5: "fix-rtk-float" };
/**
 * Messages of the states of a clock.
 * @type {Record<string, string>}
 */
const CLOCKS = {
  "in step": "clock-in-step",
  "own, shifted": "clock-shifted",
  jumped: "clock-jumped",
};
const NEAR_START_M = 4;
const LOOP_WALKED_M = 20; // shortest path of a loop
const LOW_DISK_S = 600;
const LOW_BATTERY = 0.15;
const HIGH_LOSS = 0.01;
const GRACE_S = 3; // no sensor is shown as silent this soon after the start

export const isCapturing = (/** @type {string} */ state) =>
  state === "recording" || state === "paused";

export function clock(/** @type {number} */ seconds) {
  const s = Math.floor(seconds);
  const pad = (/** @type {number} */ n) => String(n).padStart(2, "0");
  return s >= 3600
    ? `${Math.floor(s / 3600)}:${pad(Math.floor(s / 60) % 60)}:${pad(s % 60)}`
    : `${Math.floor(s / 60)}:${pad(s % 60)}`;
}

/**
 * Text and CSS class of the state: {text, className}.
 * @param {string} state
 * @param {boolean} linked
 */
export function stateText(state, linked) {
  if (!linked)
    return { text: t(state ? "no-link" : "connecting"), className: state ? "error" : "" };
  const message = `state-${state}`;
  return {
    text: t(hasText(message) ? message : "connecting"),
    className: state === "recording" ? "on" : "",
  };
}

/**
 * The warning shown in place of all others while there is no link.
 * @param {string} state
 * @param {number} seconds
 * @returns {import("./messages").Warning}
 */
export const linkLost = (state, seconds) => ({
  level: "error",
  text: t(isCapturing(state) ? "link-lost-recording" : "link-lost", { seconds: String(seconds) }),
});

/**
 * Sensors, disk and batteries in brief: [{text, error}].
 * @param {Message} given
 * @param {string} state
 * @param {Phone | null} phone
 */
export function chips({ lidars = [], rates = {}, fix, status, battery }, state, phone) {
  if (!status || !isCapturing(state)) return [];
  const samples = Object.entries(rates).filter(([name, rate]) =>
    name === "GNSS" ? rate > 0 && !fix : name === "IMU",
  );
  const fresh = status.seconds < GRACE_S;
  /** @type {Chip[]} */
  const sensors = [
    ...lidars.map(lidarChip),
    ...samples.map(([name, rate]) => rateChip(name, rate)),
  ];
  const found = sensors.map((chip) => (fresh && chip.silent ? { text: `${chip.silent} …` } : chip));
  if (fix) found.push({ text: fixText(fix), error: !(fix.quality > 0) });
  const left = status.disk.left_s;
  if (left !== null)
    found.push({ text: t("disk-brief", { left: duration(left) }), error: left < LOW_DISK_S });
  if (battery)
    found.push({
      text: t("laptop-brief", { charge: charge(battery) }),
      error: battery.charge < LOW_BATTERY && !battery.mains,
    });
  if (phone)
    found.push({
      text: t("phone-brief", { charge: percent(phone.level) }),
      error: phone.level < LOW_BATTERY && !phone.charging,
    });
  return found.map(({ text, error }) => ({
    text: error ? `✕ ${text}` : text,
    error: Boolean(error),
  }));
}

/** @returns {Chip} */
function lidarChip(/** @type {Lidar} */ { name, per_s: rate, lost, clock: keeps }) {
  if (lost !== null && lost > HIGH_LOSS)
    return { text: t("lost-brief", { name, ratio: percent(lost) }), error: true };
  if (rate >= 1 && keeps && keeps !== "in step")
    return { text: `${name} ${Math.round(rate)}/s, ${t(`${CLOCKS[keeps] ?? keeps}-brief`)}` };
  return rateChip(name, rate);
}

/**
 * @param {string} name
 * @param {number} rate
 * @returns {Chip}
 */
const rateChip = (name, rate) =>
  rate < 1
    ? { text: t("silent-brief", { name }), error: true, silent: name }
    : { text: `${name} ${Math.round(rate)}/s` };

/**
 * All values of sensors and supplies: [[name, value], …]; LiDARs have a separate table.
 * @param {Message} newest
 * @param {Phone | null} phone
 * @returns {Array<[string, string]>}
 */
export function supplies({ rates = {}, fix, status, battery }, phone) {
  if (!status) return [];
  const { free_bytes: free, left_s: left } = status.disk;
  const lost = status.kernel_drops + status.file.dropped;
  return [
    [t("imu"), rates.IMU >= 1 ? `${Math.round(rates.IMU)}/s` : t("silent")],
    [t("gnss-name"), positionText(fix, rates.GNSS ?? 0)],
    [
      t("disk"),
      left === null
        ? t("disk-free", { gigabytes: free / 1e9 })
        : t("disk-free-for", { gigabytes: free / 1e9, left: duration(left) }),
    ],
    [
      t("recorded"),
      t(lost ? "recorded-lost" : "recorded-whole", {
        megabytes: status.file.written_bytes / 1e6,
        lost: String(lost),
      }),
    ],
    [t("computer"), battery ? poweredText(battery) : t("no-battery")],
    [t("phone"), phone ? chargingText(phone) : t("battery-unknown")],
  ];
}

/** @param {Battery} battery */
const poweredText = (battery) =>
  battery.mains ? t("on-mains", { charge: charge(battery) }) : charge(battery);

/** @param {Phone} phone */
const chargingText = ({ level, charging }) =>
  charging ? t("charging", { charge: percent(level) }) : percent(level);

/**
 * @param {Fix | null | undefined} fix
 * @param {number} rate
 */
function positionText(fix, rate) {
  if (fix) return fixText(fix).replace("GNSS ", "");
  return rate > 0 ? t("no-position-yet", { rate: String(Math.round(rate)) }) : t("none");
}

/** A row of the table of LiDARs: [name, rate, lost, clock]. */
export const lidarRow = (/** @type {Lidar} */ { name, per_s: rate, lost, clock: keeps, jumps }) => [
  name,
  rate < 1 ? t("silent") : `${Math.round(rate)}/s`,
  lost === null ? "–" : t("ratio", { ratio: lost }),
  keeps ? t(CLOCKS[keeps] ?? keeps, { jumps }) : "–",
];

const percent = (/** @type {number} */ ratio) => `${Math.round(100 * ratio)} %`;
const charge = (/** @type {Battery} */ { charge: ratio, left_s: left }) =>
  `${percent(ratio)}${left === null ? "" : `, ${duration(left)}`}`;

function fixText(/** @type {Fix} */ { quality, sd_m: sd }) {
  const name = t(FIXES[quality] ?? "fix-none");
  const within = sd && quality > 0 ? Math.max(sd[0], sd[1]) : null;
  if (within === null) return t("gnss", { fix: name });
  return within < 1
    ? t("gnss-within-cm", { fix: name, cm: 100 * within })
    : t("gnss-within-m", { fix: name, m: within });
}

const duration = (/** @type {number} */ s) =>
  s > 7200
    ? t("hours", { hours: String(Math.floor(s / 3600)) })
    : t("minutes", { minutes: String(Math.max(0, Math.floor(s / 60))) });

/**
 * What the operator should do next.
 * @param {string} state
 * @param {Pick<Message, "loop">} newest
 * @param {{mayCapture: boolean | null, mapped: boolean}} page
 */
export function hint(state, { loop }, { mayCapture, mapped }) {
  if (state === "none") return t(mayCapture ? "hint-start" : "hint-view");
  if (state === "finishing") return t("hint-finishing");
  if (state === "ready") return t(mayCapture ? "hint-make" : "hint-over");
  if (state === "paused") return t("hint-paused");
  if (!mapped) return t("hint-still");
  if (!loop || !((loop.walked_m ?? 0) > LOOP_WALKED_M)) return t("hint-walk");
  if (loop.closed)
    return loop.drift_m == null
      ? t("hint-closed")
      : t("hint-closed-drift", { cm: String(Math.round(100 * loop.drift_m)) });
  if (loop.start_m < NEAR_START_M) return t("hint-at-start");
  return t("hint-open", { m: String(Math.round(loop.start_m)) });
}

/**
 * Texts of the coverage bar: {well, poor, text, count, all (gaps), one (chosen gap)}.
 * @param {Gaps | null | undefined} gaps
 * @param {number} chosen
 */
export function coverageTexts(gaps, chosen) {
  const ratio = (/** @type {number | null | undefined} */ value) =>
    value === null || value === undefined ? "–" : percent(value);
  const count = gaps?.gaps.length ?? 0;
  const elsewhere = gaps?.elsewhere ?? 0; // on other floors
  const gap = gaps?.gaps[chosen];
  const text = gap
    ? `${chosen + 1}/${count} ›`
    : count
      ? `${count} ›`
      : t(elsewhere ? "gaps-none-here" : "gaps-none");
  const others = elsewhere ? t("gaps-elsewhere", { count: String(elsewhere) }) : "";
  const all = t(count ? "gaps-next" : "gaps-no", { count, elsewhere: others });
  const one = gap
    ? t("gap-chosen", { width: gap.width_m, away: gap.away_m, elsewhere: others })
    : "";
  return {
    well: ratio(gaps?.well),
    poor: ratio(gaps?.well == null ? null : 1 - gaps.well),
    text,
    count,
    all,
    one,
  };
}
