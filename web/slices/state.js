// What is cut and how it is shown; the address of the page is this state. No DOM, no network.

const NUMBERS = { z: 1.5, t: 0.1, step: 0.1, count: 1, spacing: 0.5 };
const LISTS = { a: [0, 0], b: [1, 0], o: [0, 0, 0], n: [0, 0, 1] };
const WORDS = {
  kind: "horizontal",
  color: "height",
  ref: "",
  method: "plane",
  beside: "",
  besideColor: "",
  source: "",
  surface: "fitted",
  mark: "",
};
const MAYBE = ["lo", "hi", "u", "v", "m"];

export const COLORS = {
  height: "Height",
  intensity: "Intensity",
  normalized: "Normalized intensity",
  time: "Time",
  sensor: "Sensor",
  distance: "Distance to reference",
};

/** Where the points are drawn. */
export const SURFACES = {
  fitted: "on fitted surfaces",
  raw: "as measured",
  strays: "stray returns only",
};

/** The state in the query of an address; an invalid value becomes the default. */
export function parse(query) {
  const given = new URLSearchParams(query);
  const number = (text, usual) =>
    text !== null && text !== "" && Number.isFinite(Number(text)) ? Number(text) : usual;
  const state = {};
  for (const [key, usual] of Object.entries(NUMBERS)) state[key] = number(given.get(key), usual);
  for (const key of MAYBE) state[key] = number(given.get(key), null);
  for (const [key, usual] of Object.entries(WORDS)) state[key] = given.get(key) ?? usual;
  for (const [key, usual] of Object.entries(LISTS)) {
    const list = (given.get(key) ?? "").split(",").map((text) => number(text, NaN));
    state[key] = list.length === usual.length && list.every(Number.isFinite) ? list : [...usual];
  }
  if (!["horizontal", "vertical", "free"].includes(state.kind)) state.kind = "horizontal";
  if (!(state.color in COLORS)) state.color = "height";
  if (!(state.surface in SURFACES)) state.surface = "fitted";
  if (!(state.t > 0)) state.t = NUMBERS.t;
  state.given = given.has("kind");
  return state;
}

const short = (x) => String(Number(x.toFixed(4)));

/** The query that `parse` reads; only what differs from the default. */
export function format(state) {
  const query = new URLSearchParams({ kind: state.kind });
  const used = { horizontal: ["z"], vertical: ["a", "b"], free: ["o", "n"] }[state.kind];
  for (const key of used) query.set(key, [state[key]].flat().map(short).join(","));
  for (const [key, usual] of Object.entries(NUMBERS))
    if (key !== "z" && state[key] !== usual) query.set(key, short(state[key]));
  for (const key of MAYBE)
    if (state[key] !== null)
      query.set(key, key === "m" ? String(Number(state[key].toPrecision(5))) : short(state[key]));
  for (const [key, usual] of Object.entries(WORDS))
    if (key !== "kind" && state[key] !== usual) query.set(key, state[key]);
  return query.toString().replaceAll("%2C", ",").replaceAll("%3A", ":");
}

/** The slice as the server expects it. */
export function planeOf(state) {
  const thickness_m = state.t;
  if (state.kind === "horizontal") return { kind: state.kind, z_m: state.z, thickness_m };
  if (state.kind === "vertical")
    return { kind: state.kind, a_m: state.a, b_m: state.b, thickness_m };
  return { kind: state.kind, origin_m: state.o, normal: state.n, thickness_m };
}

/** Unit normal of the slice, the same as on the server. */
export function normalOf(state) {
  if (state.kind === "horizontal") return [0, 0, 1];
  if (state.kind === "vertical") {
    const [dx, dy] = [state.b[0] - state.a[0], state.b[1] - state.a[1]];
    const length = Math.hypot(dx, dy) || 1;
    return [dy / length, -dx / length, 0];
  }
  const length = Math.hypot(...state.n) || 1;
  return state.n.map((x) => x / length);
}

/** How far a point lies from the plane of the slice [m]. */
export function distanceFrom(state, p) {
  const n = normalOf(state);
  const on = {
    horizontal: () => [0, 0, state.z],
    vertical: () => [...state.a, 0],
    free: () => state.o,
  }[state.kind]();
  return Math.abs(p.reduce((sum, x, k) => sum + (x - on[k]) * n[k], 0));
}

/** The same slice farther along its normal. */
export function moved(state, distance) {
  const n = normalOf(state);
  const shift = (p) => p.map((x, k) => x + distance * n[k]);
  if (state.kind === "horizontal") return { ...state, z: state.z + distance };
  if (state.kind === "vertical") return { ...state, a: shift(state.a), b: shift(state.b) };
  return { ...state, o: shift(state.o) };
}

const MOST_PX = 4096; // per side, as `MAX_SIDE_PX` of the server
const LEAST_PX = 16;

/** Pixels to request of an image shown at a size [CSS px]; a huge screen gets coarser ones. */
export function imageSize(width, height, ratio) {
  const scale = Math.min(2, ratio || 1, MOST_PX / Math.max(width, height, 1));
  const [across, up] = [width, height].map((side) => Math.max(LEAST_PX, Math.round(side * scale)));
  return { width: across, height: up };
}

/**
 * The state without the view: horizontal, vertical and free slices have different coordinates, so
 * the view of one is invalid in another.
 */
export const unframed = (state) => ({ ...state, u: null, v: null, m: null });

/** Azimuth (clockwise from y) and tilt (0 = level plane) of a normal, in degrees. */
export function anglesOf([x, y, z]) {
  const flat = Math.hypot(x, y);
  return {
    azimuth: (Math.round((Math.atan2(x, y) * 1800) / Math.PI) / 10 + 360) % 360,
    tilt: Math.round((Math.atan2(flat, z) * 1800) / Math.PI) / 10,
  };
}

export function normalFrom({ azimuth, tilt }) {
  const [a, t] = [(azimuth * Math.PI) / 180, (tilt * Math.PI) / 180];
  return [Math.sin(t) * Math.sin(a), Math.sin(t) * Math.cos(a), Math.cos(t)];
}
