// Texts of the operator's page, from the messages of the stream. No elements, no state.

/** @import {Battery, Fix, Gaps, Lidar, Message, Phone} from "./messages" */
/** @typedef {{text: string, error?: boolean, silent?: string}} Chip */

/** @type {Record<string, string>} */
const STATES = {
  none: "Nothing is recorded",
  recording: "Recording",
  paused: "Paused",
  finishing: "Finishing",
  ready: "Ready",
};
/** @type {Record<number, string>} */
const FIXES = { 1: "single", 2: "DGNSS", 4: "RTK fixed", 5: "RTK float" };
/** @type {Record<string, string>} */
const CLOCKS = { "own, shifted": "own clock", jumped: "clock jumped" };
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
  if (!linked) return { text: state ? "No link" : "Connecting", className: state ? "error" : "" };
  return { text: STATES[state] ?? "Connecting", className: state === "recording" ? "on" : "" };
}

/**
 * The warning shown in place of all others while there is no link.
 * @param {string} state
 * @param {number} seconds
 * @returns {import("./messages").Warning}
 */
export const linkLost = (state, seconds) => ({
  level: "error",
  text:
    `No link for ${seconds} s, trying again.` +
    (isCapturing(state) ? " The recording continues" : ""),
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
  if (left !== null) found.push({ text: `disk ${duration(left)}`, error: left < LOW_DISK_S });
  if (battery)
    found.push({
      text: `laptop ${charge(battery)}`,
      error: battery.charge < LOW_BATTERY && !battery.mains,
    });
  if (phone)
    found.push({
      text: `phone ${percent(phone.level)}`,
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
    return { text: `${name} ${percent(lost)} lost`, error: true };
  if (rate >= 1 && keeps && keeps !== "in step")
    return { text: `${name} ${Math.round(rate)}/s, ${CLOCKS[keeps] ?? keeps}` };
  return rateChip(name, rate);
}

/**
 * @param {string} name
 * @param {number} rate
 * @returns {Chip}
 */
const rateChip = (name, rate) =>
  rate < 1
    ? { text: `${name} silent`, error: true, silent: name }
    : { text: `${name} ${Math.round(rate)}/s` };

/**
 * All values of sensors and supplies: [[name, value], …]; LiDARs have a separate table.
 * @param {Message} newest
 * @param {Phone | null} phone
 * @returns {Array<[string, string]>}
 */
export function supplies({ rates = {}, fix, status, battery, notes }, phone) {
  if (!status) return [];
  const { free_bytes: free, left_s: left } = status.disk;
  const lost = status.kernel_drops + status.file.dropped;
  return [
    ["IMU", rates.IMU >= 1 ? `${Math.round(rates.IMU)}/s` : "silent"],
    [
      "GNSS",
      fix
        ? fixText(fix).replace("GNSS ", "")
        : rates.GNSS > 0
          ? `${Math.round(rates.GNSS)}/s, no position yet`
          : "none",
    ],
    [
      "Disk",
      `${(free / 1e9).toFixed(0)} GB free` +
        (left === null ? "" : `, for ${duration(left)} at this rate`),
    ],
    [
      "Recorded",
      `${(status.file.written_bytes / 1e6).toFixed(0)} MB, ` +
        (lost ? `${lost} packets lost` : "nothing lost"),
    ],
    [
      "Computer",
      battery ? `${charge(battery)}${battery.mains ? ", on mains" : ""}` : "no battery, or unknown",
    ],
    [
      "Phone",
      phone ? `${percent(phone.level)}${phone.charging ? ", charging" : ""}` : "battery unknown",
    ],
    ...(notes?.counts.clock_jumps ? [clocksRow(notes.counts.clock_jumps)] : []),
  ];
}

/** @returns {[string, string]} */
const clocksRow = (/** @type {number} */ jumps) => ["Clocks", `jumped ${jumps} times, corrected`];

/** A row of the table of LiDARs: [name, rate, lost, clock]. */
export const lidarRow = (/** @type {Lidar} */ { name, per_s: rate, lost, clock: keeps }) => [
  name,
  rate < 1 ? "silent" : `${Math.round(rate)}/s`,
  lost === null ? "–" : `${(100 * lost).toFixed(1)} %`,
  keeps || "–",
];

const percent = (/** @type {number} */ ratio) => `${Math.round(100 * ratio)} %`;
const charge = (/** @type {Battery} */ { charge: ratio, left_s: left }) =>
  `${percent(ratio)}${left === null ? "" : `, ${duration(left)}`}`;

function fixText(/** @type {Fix} */ { quality, sd_m: sd }) {
  const name = FIXES[quality] ?? "no fix";
  const within = sd && quality > 0 ? Math.max(sd[0], sd[1]) : null;
  return within === null
    ? `GNSS ${name}`
    : `GNSS ${name} ±${within < 1 ? `${Math.round(100 * within)} cm` : `${within.toFixed(1)} m`}`;
}

const duration = (/** @type {number} */ s) =>
  s > 7200 ? `${Math.floor(s / 3600)} h` : `${Math.max(0, Math.floor(s / 60))} min`;

/**
 * What the operator should do next.
 * @param {string} state
 * @param {Pick<Message, "loop">} newest
 * @param {{mayCapture: boolean | null, mapped: boolean}} page
 */
export function hint(state, { loop }, { mayCapture, mapped }) {
  if (state === "none")
    return mayCapture
      ? "Put the backpack on, stand still, then start"
      : "View only. Nothing is recorded yet";
  if (state === "finishing") return "The recording is safe; the map is being completed";
  if (state === "ready")
    return mayCapture
      ? "Everything is stored. Now make the map"
      : "The walk is over; everything is stored";
  if (state === "paused") return "Stay here: resume where the pause began";
  if (!mapped) return "Stand still: the map starts in a few seconds";
  if (!loop || !((loop.walked_m ?? 0) > LOOP_WALKED_M))
    return "Open all rooms and walk slowly through each";
  if (loop.closed)
    return loop.drift_m == null
      ? "✓ Loop closed"
      : `✓ Loop closed, drift ${Math.round(100 * loop.drift_m)} cm`;
  if (loop.start_m < NEAR_START_M) return "At the start, loop not closed yet";
  return `Loop open: return to the start, ${Math.round(loop.start_m)} m`;
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
      : elsewhere
        ? "none here"
        : "none";
  const others = elsewhere ? `, ${elsewhere} on other floors` : "";
  const all = count
    ? `${count} ${count === 1 ? "place" : "places"} not seen${others}, show the next`
    : `No gaps near your path${others}`;
  const one = gap
    ? `Not seen: ${gap.width_m.toFixed(1)} m wide, ` +
      `${gap.away_m.toFixed(0)} m from your path${others}`
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
