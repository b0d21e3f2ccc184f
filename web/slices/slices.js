// The page of slices: plane, display, findings. The address of the page is the state.

import { idHere } from "../shared/address.js";
import {
  aboveUrl,
  ApiError,
  pickOnSlice,
  readAboveWindow,
  readProject,
  readSlice,
  readSliceFacts,
} from "../shared/api.js";
import { approvalFact } from "../shared/approval_lines.js";
import { byId, fill, make, showError, targetOf } from "../shared/dom.js";
import { count } from "../shared/format.js";
import { cutText, distanceText, imageText, lengthText, pointText } from "./captions.js";
import { controls } from "./controls.js";
import { findings } from "./findings.js";
import { legend } from "./legend.js";
import { help } from "./help.js";
import { isPlan, showPlan } from "./plan.js";
import { stretchMark } from "./stretch_mark.js";
import { COLORS, SURFACES, planeOf, format, moved, normalFrom, parse, unframed } from "./state.js";
import { factsIn } from "../shared/verdict.js";
import "../shared/map_verdict.js";
import "../shared/page_head.js";
import "./above.js";
import "./view.js";

const id = idHere();
const dark = matchMedia("(prefers-color-scheme: dark)");
const above = make("slice-above");
const first = make("slice-view");
const second = make("slice-view", { className: "second" });
const swipe = make("input", {
  type: "range",
  min: 0,
  max: 100,
  value: 50,
  ariaLabel: "Swipe between the two slices",
  className: "swipe",
  hidden: true,
});
const captions = [make("p", { className: "caption" }), make("p", { className: "caption second" })];
const reading = make("p", { className: "readout", role: "status" });
const facing = make("div", { className: "facing" });
let facts = null;
let state = parse(location.search);
let measuring = false;
let measured = [];
let picked = null;
let shown = null;
let turn = 0;

/** Changes the state, the address, and what depends on them. */
function change(next, { keep = false } = {}) {
  const before = state;
  state = { ...state, ...next };
  const elsewhere =
    format({ ...before, color: "", t: 0 }) !== format({ ...state, color: "", t: 0 });
  if (!keep && elsewhere) clearMeasure();
  if (state.u === null) first.frame = second.frame = null;
  else if (next.m) first.frame = second.frame = { u: state.u, v: state.v, m: state.m };
  history.replaceState(null, "", `?${format(state)}`);
  above.state = state;
  panel.show(state);
  found.show(state);
  layOut();
  load();
}

const step = (times) => change(moved(state, times * state.step));
const toKind = (kind) => kind !== state.kind && change(unframed({ ...state, ...start(kind) }));

/** A plane of another kind at the present one, or near the middle of the map. */
function start(kind) {
  const [low, high] = facts.bounds_m;
  const middle = low.map((x, k) => (x + high[k]) / 2);
  const at =
    shown && state.kind === "horizontal" && first.frame ? [first.frame.u, first.frame.v] : middle;
  if (kind === "horizontal")
    return { kind, z: state.given ? state.z : low[2] + Math.min(1.2, (high[2] - low[2]) / 2) };
  if (kind === "vertical") {
    const wide = high[0] - low[0] >= high[1] - low[1];
    return wide
      ? { kind, a: [low[0], at[1]], b: [high[0], at[1]] }
      : { kind, a: [at[0], low[1]], b: [at[0], high[1]] };
  }
  return { kind, o: [...at.slice(0, 2), middle[2]], n: normalFrom({ azimuth: 0, tilt: 45 }) };
}

// -- slice images

const ask = (view, more) => ({
  plane: planeOf(state),
  color: state.color,
  low: state.lo,
  high: state.hi,
  reference: state.ref,
  method: state.method,
  source: state.source,
  surface: state.surface,
  ground: dark.matches ? "dark" : "light",
  ...view.wanted,
  ...more,
});

async function load() {
  const mine = ++turn;
  const page = `${tab}1`;
  document.body.classList.add("drawing");
  try {
    const image = await readSlice(id, ask(first, { page, turn: mine }));
    if (mine !== turn) return;
    await first.show(image);
    shown = image;
    if (state.beside || state.besideColor) await loadSecond(mine);
    byId("message").textContent = "";
    describe();
  } catch (error) {
    if (mine !== turn || error.name === "Superseded") return;
    showError(byId("message"), error);
    if (error instanceof ApiError && error.status === 422) first.clear();
  } finally {
    if (mine === turn) document.body.classList.remove("drawing");
  }
}

async function loadSecond(mine) {
  second.frame = first.frame;
  const color = state.besideColor || state.color;
  const range = color === state.color ? {} : { low: null, high: null };
  const image = await readSlice(
    id,
    ask(second, { page: `${tab}2`, turn: mine, color, source: state.beside, ...range }),
  );
  if (mine !== turn) return;
  await second.show(image);
  captions[1].textContent = imageText(
    { source: state.beside, color, points: count(image.points), surface: image.surface },
    facts.sources,
  );
}

function describe() {
  const [name, points] = [shown.name, count(shown.points)];
  captions[0].textContent = imageText(
    { source: state.source, color: state.color, points, surface: shown.surface },
    facts.sources,
  );
  const where = `${points} points ${SURFACES[shown.surface]}`;
  first.label = `Slice ${name}, ${where}, colored by ${COLORS[state.color]}`;
  second.label = captions[1].textContent;
  fill(
    facing,
    make("strong", {}, cutText(state.kind, name)),
    make("span", {}, `${Number((state.t * 100).toFixed(1))} cm thick`),
    make("span", {}, where),
    ...(facts.strays && shown.surface !== "strays"
      ? [make("span", {}, `${count(facts.strays)} stray returns left out`)]
      : []),
    make("span", { className: "frame" }, facts.frame),
    approvalFact(facts.approval),
  );
  legend(byId("legend"), {
    state,
    shown,
    facts,
    onRange: (lo, hi) => change({ lo, hi }, { keep: true }),
  });
  mark();
}

// -- reading points

async function place({ u, v, reach }) {
  const answer = await pickOnSlice(id, {
    plane: planeOf(state),
    uv: [u, v],
    radius_m: Math.min(5, Math.max(0.005, reach)),
    source: state.source,
    surface: state.surface,
  });
  if (!answer.found) {
    reading.textContent = "No point of the map here";
    return;
  }
  picked = answer;
  if (measuring) measured = measured.length >= 2 ? [answer] : [...measured, answer];
  found.picked(answer);
  mark();
  reading.textContent =
    measured.length === 2 ? distanceText(measured[0], measured[1]) : pointText(answer, facts);
}

function mark() {
  const line = measured.length === 2 ? lengthText(measured[0], measured[1]) : "";
  const points = measuring || measured.length ? measured : [picked].filter(Boolean);
  const marks = [stretchMark(state), { points: points.map((one) => one.uv), text: line }];
  first.marks = marks;
  second.marks = marks;
}

function clearMeasure() {
  measured = [];
  picked = null;
  reading.textContent = measuring ? "Click two points" : "";
}

function measure(on = !measuring) {
  measuring = on;
  clearMeasure();
  byId("measure").setAttribute("aria-pressed", String(measuring));
  mark();
}

// -- two slices

function layOut() {
  const two = Boolean(state.beside || state.besideColor);
  const views = byId("views");
  views.classList.toggle("two", two);
  views.classList.toggle("swiping", two && views.dataset.mode === "swipe");
  second.hidden = captions[1].hidden = !two;
  swipe.hidden = !(two && views.dataset.mode === "swipe");
  second.style.clipPath = swipe.hidden ? "" : `inset(0 0 0 ${swipe.value}%)`;
}

function follow(from, to) {
  from.addEventListener("moving", () => {
    to.frame = from.frame;
  });
  from.addEventListener("frame", () => {
    to.frame = from.frame;
    change(from.frame, { keep: true });
  });
  from.addEventListener("place", (event) =>
    place(event.detail).catch((error) => showError(byId("message"), error)),
  );
}

// -- keys

const KEYS = {
  "[": () => step(-1),
  PageDown: () => step(-1),
  "]": () => step(1),
  PageUp: () => step(1),
  h: () => toKind("horizontal"),
  v: () => toKind("vertical"),
  f: () => toKind("free"),
  "+": () => thicker(2),
  "=": () => thicker(2),
  "-": () => thicker(0.5),
  c: () => nextColor(),
  m: () => measure(),
  r: () => otherSurface(),
  0: () => change(unframed(state), { keep: true }),
  Escape: () => measure(false),
  "?": () => byId("help", HTMLDialogElement).showModal(),
};

const thicker = (times) =>
  change(
    { t: Number(Math.min(100, Math.max(0.001, state.t * times)).toPrecision(6)) },
    { keep: true },
  );

function otherSurface() {
  const every = Object.keys(SURFACES);
  const next = every[(every.indexOf(state.surface) + 1) % every.length];
  if (facts.surface === "fitted") change({ surface: next }, { keep: true });
}

function nextColor() {
  const able = Object.keys(COLORS).filter(
    (color) =>
      (color !== "distance" || state.ref) &&
      (color !== "normalized" || facts.fields.includes("intensity_normalized")),
  );
  change(
    { color: able[(able.indexOf(state.color) + 1) % able.length], lo: null, hi: null },
    { keep: true },
  );
}

addEventListener("keydown", (event) => {
  const typing = targetOf(event).closest?.("input:not([type=range]), select, textarea, dialog");
  if (typing || event.ctrlKey || event.metaKey || event.altKey || !facts) return;
  const action = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!action) return;
  event.preventDefault();
  action();
});

// -- begin

const tab = Math.random().toString(36).slice(2, 12);
const panel = controls(byId("controls"), { change, toKind });
const found = findings(byId("findings"), {
  id,
  change,
  state: () => state,
  ask: () => ask(first),
  point: (p) => (above.place = p),
  reload,
  measured: () => picked,
});

function tools() {
  const button = (text, action, more = {}) =>
    make("button", { type: "button", onclick: action, ...more }, text);
  const mode = (text, value) =>
    button(
      text,
      () => {
        byId("views").dataset.mode = value;
        layOut();
      },
      { id: `mode-${value}` },
    );
  byId("tools").replaceChildren(
    make(
      "span",
      { className: "moves" },
      button("◂ Step", () => step(-1), { title: "One step back  [", ariaLabel: "Step back" }),
      button("Step ▸", () => step(1), { title: "One step forward  ]", ariaLabel: "Step forward" }),
      button("−", () => first.zoom(1.5), { title: "Zoom out", ariaLabel: "Zoom out" }),
      button("+", () => first.zoom(1 / 1.5), { title: "Zoom in", ariaLabel: "Zoom in" }),
      button("All", () => change(unframed(state), { keep: true }), {
        title: "Whole slice  0",
      }),
      button("Measure", () => measure(), {
        id: "measure",
        ariaPressed: "false",
        title: "Distance between two points  M",
      }),
    ),
    make(
      "span",
      { className: "beside" },
      ...panel.beside,
      mode("Split", "split"),
      mode("Swipe", "swipe"),
    ),
    button("?", () => byId("help", HTMLDialogElement).showModal(), {
      ariaLabel: "Help",
      title: "Keys  ?",
    }),
  );
  byId("views").dataset.mode = "split";
  byId("views").replaceChildren(
    make("div", { className: "one" }, first, captions[0]),
    make("div", { className: "one other" }, second, captions[1]),
    swipe,
  );
  byId("under").replaceChildren(make("div", { id: "legend" }), facing, reading);
  swipe.addEventListener("input", layOut);
}

async function reload() {
  facts = await readSliceFacts(id, state.source);
  panel.facts(facts);
  found.facts(facts);
}

async function begin() {
  byId("above").append(above);
  tools();
  help(byId("help"));
  follow(first, second);
  follow(second, first);
  above.addEventListener("slice", ({ detail }) =>
    change(
      state.kind === "vertical" ? detail : unframed({ ...state, kind: "vertical", ...detail }),
    ),
  );
  dark.addEventListener("change", load);
  try {
    const project = await readProject(id);
    document.querySelector("page-head").name = project.name;
    document.querySelector("map-verdict").facts = factsIn(project.summary);
    document.title = `Slices · ${project.name} · recon4`;
    if (isPlan(project)) return showPlan(id, project);
    await reload();
    if (!state.given) state = { ...state, ...start("horizontal"), given: true };
    if (state.u !== null && state.v !== null && state.m !== null)
      first.frame = { u: state.u, v: state.v, m: state.m };
    change({});
    above.show(aboveUrl(id, facts.key), await readAboveWindow(id));
  } catch (error) {
    showError(byId("message"), error);
  }
}

addEventListener("popstate", () => change(parse(location.search)));
begin();
