// What the operator's page says, from what the stream told. No elements, no state.

const STATES = { none: "Nothing is recorded", recording: "Recording", paused: "Paused", finishing: "Finishing", ready: "Ready" };
const FIXES = { 1: "single", 2: "DGNSS", 4: "RTK fixed", 5: "RTK float" };
const NEAR_START_M = 4;
const LITTLE_LEFT_S = 600;

export function clock(seconds) {
  const s = Math.floor(seconds);
  const pad = (n) => String(n).padStart(2, "0");
  return s >= 3600 ? `${Math.floor(s / 3600)}:${pad(Math.floor(s / 60) % 60)}:${pad(s % 60)}` : `${Math.floor(s / 60)}:${pad(s % 60)}`;
}

/** The state in words and how it is shown: {words, look}. */
export function stateWords(state, linked) {
  if (!linked) return { words: state === "recording" ? "No link. The recording goes on" : "No link, trying again", look: "bad" };
  return { words: STATES[state] ?? "Connecting", look: state === "recording" ? "on" : "" };
}

/** Sensors, disk and battery: [{words, bad}]. */
export function sensorWords({ rates = {}, fix, status }, state, battery) {
  if (!status || !["recording", "paused"].includes(state)) return [];
  const chips = Object.entries(rates)
    .filter(([name, rate]) => name !== "GNSS" || rate > 0)
    .map(([name, rate]) => (rate < 1 ? { words: `✕ ${name} silent`, bad: true } : { words: `${name} ${Math.round(rate)}/s` }));
  if (fix) chips.push({ words: fixWords(fix) });
  const left = status.disk.left_s;
  if (left !== null) chips.push({ words: `disk ${duration(left)}`, bad: left < LITTLE_LEFT_S });
  if (battery) chips.push({ words: `phone ${Math.round(100 * battery.level)} %`, bad: battery.level < 0.15 });
  return chips;
}

function fixWords({ quality, sd_m: sd }) {
  const name = FIXES[quality] ?? "no fix";
  return sd ? `GNSS ${name} ±${sd[0] < 1 ? `${Math.round(100 * sd[0])} cm` : `${sd[0].toFixed(1)} m`}` : `GNSS ${name}`;
}

const duration = (s) => (s > 7200 ? `${Math.floor(s / 3600)} h` : `${Math.max(0, Math.floor(s / 60))} min`);

/** What to do next, in words. */
export function hint(state, { loop }, mayCapture) {
  if (state === "none") return mayCapture ? "Put the backpack on, stand still, then start" : "You are looking on. Nothing is recorded yet";
  if (state === "finishing") return "What was recorded is safe; its map is being completed";
  if (state === "ready") return mayCapture ? "Everything is stored. Now make the map" : "The walk is over; everything is stored";
  if (state === "paused") return "Stay here: go on where the pause began";
  if (!loop || !(loop.walked_m > 5)) return "Walk slowly, doors open, through every room";
  if (loop.closed) return "✓ Loop closed";
  if (loop.start_m < NEAR_START_M) return "At the start, loop not closed yet";
  return `Loop open: return to the start, ${Math.round(loop.start_m)} m`;
}

/** Coverage in figures: {well, poor, gap, all (of the gaps, in words), one (the chosen gap)}. */
export function coverageWords(gaps, chosen) {
  const share = (value) => (value === null || value === undefined ? "–" : `${Math.round(100 * value)} %`);
  const count = gaps?.gaps.length ?? 0;
  const gap = gaps?.gaps[chosen];
  const words = gap ? `${chosen + 1}/${count} ›` : count ? `${count} ›` : "none";
  const all = count ? `${count} ${count === 1 ? "place" : "places"} not seen, show the next` : "No gaps near your way";
  const one = gap ? `Not seen: ${gap.width_m.toFixed(1)} m wide, ${gap.away_m.toFixed(0)} m from your way` : "";
  return { well: share(gaps?.well), poor: share(gaps?.well == null ? null : 1 - gaps.well), words, count, all, one };
}
