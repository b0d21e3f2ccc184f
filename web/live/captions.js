// What the operator's page says, from what the stream told. No elements, no state.

const STATES = {
  none: "Nothing is recorded",
  recording: "Recording",
  paused: "Paused",
  finishing: "Finishing",
  ready: "Ready",
};
const FIXES = { 1: "single", 2: "DGNSS", 4: "RTK fixed", 5: "RTK float" };
const CLOCKS = { "own, shifted": "own clock", jumped: "clock jumped" };
const NEAR_START_M = 4;
const SOME_WAY_M = 20; // before that no loop can close
const LITTLE_LEFT_S = 600;
const LITTLE_CHARGE = 0.15;
const MUCH_LOST = 0.01;
const GRACE_S = 3; // after the start nothing has to come yet

export const listens = (state) => state === "recording" || state === "paused";

export function clock(seconds) {
  const s = Math.floor(seconds);
  const pad = (n) => String(n).padStart(2, "0");
  return s >= 3600
    ? `${Math.floor(s / 3600)}:${pad(Math.floor(s / 60) % 60)}:${pad(s % 60)}`
    : `${Math.floor(s / 60)}:${pad(s % 60)}`;
}

/** The state in words and how it is shown: {words, look}. */
export function stateWords(state, linked) {
  if (!linked) return { words: state ? "No link" : "Connecting", look: state ? "bad" : "" };
  return { words: STATES[state] ?? "Connecting", look: state === "recording" ? "on" : "" };
}

/** What is said instead of all warnings while there is no link. */
export const lostWords = (state, seconds) => ({
  level: "bad",
  text: `No link for ${seconds} s, trying again.${listens(state) ? " The recording does not need it" : ""}`,
});

/** Sensors, disk and batteries at a glance: [{words, bad}]. */
export function chips({ lidars = [], rates = {}, fix, status, battery }, state, phone) {
  if (!status || !listens(state)) return [];
  const samples = Object.entries(rates).filter(([name, rate]) =>
    name === "GNSS" ? rate > 0 && !fix : name === "IMU",
  );
  const fresh = status.seconds < GRACE_S;
  const found = [
    ...lidars.map(lidarChip),
    ...samples.map(([name, rate]) => rateChip(name, rate)),
  ].map((chip) => (fresh && chip.silent ? { words: `${chip.silent} …` } : chip));
  if (fix) found.push({ words: fixWords(fix), bad: !(fix.quality > 0) });
  const left = status.disk.left_s;
  if (left !== null) found.push({ words: `disk ${duration(left)}`, bad: left < LITTLE_LEFT_S });
  if (battery)
    found.push({
      words: `laptop ${charge(battery)}`,
      bad: battery.charge < LITTLE_CHARGE && !battery.mains,
    });
  if (phone)
    found.push({
      words: `phone ${percent(phone.level)}`,
      bad: phone.level < LITTLE_CHARGE && !phone.charging,
    });
  return found.map(({ words, bad }) => ({ words: bad ? `✕ ${words}` : words, bad: Boolean(bad) }));
}

function lidarChip({ name, per_s: rate, lost, clock: keeps }) {
  if (lost > MUCH_LOST) return { words: `${name} ${percent(lost)} lost`, bad: true };
  if (rate >= 1 && keeps && keeps !== "in step")
    return { words: `${name} ${Math.round(rate)}/s, ${CLOCKS[keeps] ?? keeps}` };
  return rateChip(name, rate);
}

const rateChip = (name, rate) =>
  rate < 1
    ? { words: `${name} silent`, bad: true, silent: name }
    : { words: `${name} ${Math.round(rate)}/s` };

/** Every figure of sensors and supplies: [[what, figure], …]; LiDARs have a table of their own. */
export function supplies({ rates = {}, fix, status, battery, notes }, phone) {
  if (!status) return [];
  const { free_bytes: free, left_s: left } = status.disk;
  const lost = status.kernel_drops + status.file.dropped;
  return [
    ["IMU", rates.IMU >= 1 ? `${Math.round(rates.IMU)}/s` : "silent"],
    [
      "GNSS",
      fix
        ? fixWords(fix).replace("GNSS ", "")
        : rates.GNSS > 0
          ? `${Math.round(rates.GNSS)}/s, no position yet`
          : "none",
    ],
    [
      "Disk",
      `${(free / 1e9).toFixed(0)} GB free${left === null ? "" : `, for ${duration(left)} at this rate`}`,
    ],
    [
      "Recorded",
      `${(status.file.written_bytes / 1e6).toFixed(0)} MB, ${lost ? `${lost} packets lost` : "nothing lost"}`,
    ],
    [
      "Computer",
      battery
        ? `${charge(battery)}${battery.mains ? ", on mains" : ""}`
        : "has no battery, or does not tell",
    ],
    [
      "Phone",
      phone
        ? `${percent(phone.level)}${phone.charging ? ", charging" : ""}`
        : "does not tell its battery",
    ],
    ...(notes?.counts.clock_jumps
      ? [["Clocks", `jumped ${notes.counts.clock_jumps} times, put right`]]
      : []),
  ];
}

/** A row of the table of LiDARs: [name, rate, lost, clock]. */
export const lidarRow = ({ name, per_s: rate, lost, clock: keeps }) => [
  name,
  rate < 1 ? "silent" : `${Math.round(rate)}/s`,
  lost === null ? "–" : `${(100 * lost).toFixed(1)} %`,
  keeps || "–",
];

const percent = (ratio) => `${Math.round(100 * ratio)} %`;
const charge = ({ charge: ratio, left_s: left }) =>
  `${percent(ratio)}${left === null ? "" : `, ${duration(left)}`}`;

function fixWords({ quality, sd_m: sd }) {
  const name = FIXES[quality] ?? "no fix";
  const within = sd && quality > 0 ? Math.max(sd[0], sd[1]) : null;
  return within === null
    ? `GNSS ${name}`
    : `GNSS ${name} ±${within < 1 ? `${Math.round(100 * within)} cm` : `${within.toFixed(1)} m`}`;
}

const duration = (s) =>
  s > 7200 ? `${Math.floor(s / 3600)} h` : `${Math.max(0, Math.floor(s / 60))} min`;

/** What to do next, in words. */
export function hint(state, { loop }, { mayCapture, mapped }) {
  if (state === "none")
    return mayCapture
      ? "Put the backpack on, stand still, then start"
      : "You are looking on. Nothing is recorded yet";
  if (state === "finishing") return "What was recorded is safe; its map is being completed";
  if (state === "ready")
    return mayCapture
      ? "Everything is stored. Now make the map"
      : "The walk is over; everything is stored";
  if (state === "paused") return "Stay here: go on where the pause began";
  if (!mapped) return "Stand still: the map begins in a few seconds";
  if (!loop || !(loop.walked_m > SOME_WAY_M)) return "Walk slowly, doors open, through every room";
  if (loop.closed)
    return `✓ Loop closed${loop.drift_m == null ? "" : `, drift ${Math.round(100 * loop.drift_m)} cm`}`;
  if (loop.start_m < NEAR_START_M) return "At the start, loop not closed yet";
  return `Loop open: return to the start, ${Math.round(loop.start_m)} m`;
}

/** Coverage in figures: {well, poor, gap, all (of the gaps, in words), one (the chosen gap)}. */
export function coverageWords(gaps, chosen) {
  const share = (value) => (value === null || value === undefined ? "–" : percent(value));
  const count = gaps?.gaps.length ?? 0;
  const elsewhere = gaps?.elsewhere ?? 0; // on other floors
  const gap = gaps?.gaps[chosen];
  const words = gap
    ? `${chosen + 1}/${count} ›`
    : count
      ? `${count} ›`
      : elsewhere
        ? "none here"
        : "none";
  const others = elsewhere ? `, ${elsewhere} on other floors` : "";
  const all = count
    ? `${count} ${count === 1 ? "place" : "places"} not seen${others}, show the next`
    : `No gaps near your way${others}`;
  const one = gap
    ? `Not seen: ${gap.width_m.toFixed(1)} m wide, ${gap.away_m.toFixed(0)} m from your way${others}`
    : "";
  return {
    well: share(gaps?.well),
    poor: share(gaps?.well == null ? null : 1 - gaps.well),
    words,
    count,
    all,
    one,
  };
}
