// The page of slices: plane, display, findings. The address of the page is the state.

import { idHere } from "../shared/address.js";
import {
  aboveUrl,
  ApiError,
  isGuest,
  pickOnSlice,
  readAboveWindow,
  readCurrentUser,
  readProject,
  readSlice,
  readSliceFacts,
  readStretch,
} from "../shared/api.js";
import { attempt, byId, detailOf, only, say, showError, targetOf } from "../shared/dom.js";
import { count } from "../shared/format.js";
import { brushOf } from "./brush.js";
import { distanceText, imageText, planeText, pointText } from "./captions.js";
import { findings } from "./findings.js";
import { help } from "./help.js";
import { likingOf } from "./liking.js";
import { followJobs } from "./made_again.js";
import { nextColor, nextSurface } from "./next_choice.js";
import { pageMarks } from "./page_marks.js";
import { isPlan, showPlan } from "./planar_map.js";
import { endsOf, timesOf } from "./stretch_mark.js";
import { COLORS, SURFACES, format, moved, planeOf, startOf, parse, unframed } from "./state.js";
import { t } from "../shared/texts.js";
import { factsIn } from "../shared/verdict.js";
import "../shared/map_verdict.js";
import "../shared/page_head.js";
import { SliceAbove } from "./above.js";
import { drawPage, first, page, second, waitFor } from "./drawing.js";

/**
 * @import {SliceFacts, SliceImageRequest} from "../shared/http_types"
 * @import {Kind, SliceState} from "./state.js"
 * @import {Place, SliceView} from "./view.js"
 */

const id = idHere();
const tab = Math.random().toString(36).slice(2, 12);
const dark = matchMedia("(prefers-color-scheme: dark)");
const above = new SliceAbove();

/**
 * Changes the state, the address, and what depends on them.
 * @param {Partial<SliceState>} next
 */
function change(next, { keep = false } = {}) {
  const before = page.state;
  const state = { ...before, ...next };
  page.state = state;
  const place = (/** @type {SliceState} */ one) => format({ ...one, color: "height", t: 0 });
  if (place(before) !== place(state)) {
    outline("clear");
    brush({ on: false, strokes: [] });
  }
  if (!keep && place(before) !== place(state)) clearMeasure();
  const { u, v, m } = state;
  if (u === null || v === null) first.frame = second.frame = null;
  else if (next.m && m !== null) first.frame = second.frame = { u, v, m };
  history.replaceState(null, "", `?${format(state)}`);
  above.state = state;
  draw();
  found.show();
  load();
}

const step = (/** @type {number} */ times) => change(moved(page.state, times * page.state.step));

/** A plane of another kind at the present one, or near the middle of the map. */
function toKind(/** @type {Kind} */ kind) {
  const { state, facts, shown } = page;
  if (kind === state.kind || !facts) return;
  const seen = shown && state.kind === "horizontal" ? first.frame : null;
  change(unframed({ ...state, ...startOf(kind, state, facts.bounds_m, seen) }));
}

// -- slice images

/**
 * @param {SliceView} view
 * @param {Partial<SliceImageRequest>} [more]
 * @returns {SliceImageRequest}
 */
function ask(view, more) {
  const { state } = page;
  return {
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
  };
}

async function load() {
  const mine = ++page.sequence;
  waitFor(t("cutting-slice"));
  try {
    const image = await readSlice(id, ask(first, { page: `${tab}1`, sequence: mine }));
    if (mine !== page.sequence) return;
    await first.show(image);
    page.shown = image;
    if (page.state.beside || page.state.besideColor) await loadSecond(mine);
    say(byId("message"), "");
    describe();
  } catch (error) {
    if (mine !== page.sequence || (error instanceof Error && error.name === "Superseded")) return;
    showError(byId("message"), error);
    if (error instanceof ApiError && error.status === 422) first.clear();
  } finally {
    if (mine === page.sequence) waitFor("");
  }
}

async function loadSecond(/** @type {number} */ mine) {
  second.frame = first.frame;
  const { beside: source, besideColor, color: firstColor } = page.state;
  const color = besideColor || firstColor;
  const range = color === firstColor ? {} : { low: null, high: null };
  const image = await readSlice(
    id,
    ask(second, { page: `${tab}2`, sequence: mine, color, source, ...range }),
  );
  if (mine !== page.sequence) return;
  await second.show(image);
  const points = count(image.points);
  page.secondCaption = imageText(
    { source, color, points, surface: image.surface },
    page.facts?.sources ?? [],
  );
}

/** Says in words what the slices show. */
function describe() {
  const { shown, state, facts } = page;
  if (!shown || !facts) return;
  const { source, color } = state;
  const { position, surface } = shown;
  const points = count(shown.points);
  page.caption = imageText({ source, color, points, surface }, facts.sources);
  first.label = t("slice-label", {
    name: planeText(position),
    points,
    surface: SURFACES[surface],
    color: COLORS[color],
  });
  second.label = page.secondCaption;
  draw();
  mark();
}

// -- reading points

async function place(/** @type {Place} */ { u, v, reach }) {
  if (page.outline.drawing) return corner([u, v]);
  const { state, facts, measuring, measured } = page;
  const answer = await pickOnSlice(id, {
    plane: planeOf(state),
    uv: [u, v],
    radius_m: Math.min(5, Math.max(0.005, reach)),
    source: state.source,
    surface: state.surface,
  });
  if (!answer.found || !facts) return read(t("no-point-here"));
  if (page.like.on) return like({ on: false, place: answer.p_map, boxes: [] });
  page.picked = answer;
  if (measuring) page.measured = measured.length >= 2 ? [answer] : [...measured, answer];
  mark();
  const [from, to] = page.measured;
  read(from && to ? distanceText(from, to) : pointText(answer, facts));
}

function read(/** @type {string} */ text) {
  page.reading = text;
  draw();
}

function mark() {
  const marks = pageMarks(page);
  first.marks = marks;
  second.marks = marks;
}

/** Shows the error ellipses of points that were measured in the map. */
function known(/** @type {import("./ellipses.js").KnownPlace[]} */ places) {
  page.known = places;
  mark();
}

function corner(/** @type {[number, number]} */ uv) {
  page.outline = { ...page.outline, corners: [...page.outline.corners, uv] };
  mark();
  found.show();
}

/** Changes the polygon whose points get another class, and returns it. */
function outline(/** @type {"draw" | "back" | "clear" | undefined} */ action = undefined) {
  const { corners, drawing } = page.outline;
  if (action === undefined || (action === "clear" && !corners.length && !drawing))
    return page.outline;
  page.outline = {
    draw: { corners, drawing: !drawing },
    back: { corners: corners.slice(0, -1), drawing },
    clear: { corners: [], drawing: false },
  }[action];
  if (page.outline.drawing) {
    brush({ on: false });
    like({ on: false });
  }
  read(page.outline.drawing ? t("click-corners") : "");
  mark();
  found.show();
  return page.outline;
}

const brush = brushOf(page, [first, second], (on) => {
  if (on && page.outline.drawing) outline("draw");
  if (on) like({ on: false });
  mark();
  found.show();
});

const like = likingOf(page, (on) => {
  if (on && page.outline.drawing) outline("draw");
  if (on) brush({ on: false });
  read(on ? t("click-thing") : "");
  mark();
  found.show();
});

function clearMeasure() {
  Object.assign(page, { measured: [], picked: null });
  page.reading = page.measuring ? t("click-two") : "";
}

function measure(on = !page.measuring) {
  page.measuring = on;
  clearMeasure();
  draw();
  mark();
}

// -- two slices

/**
 * @param {SliceView} from
 * @param {SliceView} to
 */
function follow(from, to) {
  from.addEventListener("moving", () => {
    to.frame = from.frame;
  });
  from.addEventListener("frame", () => {
    to.frame = from.frame;
    if (from.frame) change(from.frame, { keep: true });
  });
  from.addEventListener("place", (event) =>
    place(detailOf(event)).catch((error) => showError(byId("message"), error)),
  );
}

// -- keys

/** @type {Record<string, () => void>} */
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
  c: () => change({ color: nextColor(page.state, page.facts), lo: null, hi: null }, { keep: true }),
  m: () => measure(),
  r: () => otherSurface(),
  0: () => showAll(),
  Escape: () => {
    if (page.outline.drawing) outline("draw");
    brush({ on: false });
    like({ on: false });
    measure(false);
  },
  "?": () => showHelp(),
};

const showAll = () => change(unframed(page.state), { keep: true });
const showHelp = () => byId("help", HTMLDialogElement).showModal();

const thicker = (/** @type {number} */ times) =>
  change(
    { t: Number(Math.min(100, Math.max(0.001, page.state.t * times)).toPrecision(6)) },
    { keep: true },
  );

function otherSurface() {
  if (page.facts?.surface === "fitted")
    change({ surface: nextSurface(page.state) }, { keep: true });
}

addEventListener("keydown", (event) => {
  const typing = targetOf(event).closest?.("input:not([type=range]), select, textarea, dialog");
  if (typing || event.ctrlKey || event.metaKey || event.altKey || !page.facts) return;
  const action = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!action) return;
  event.preventDefault();
  action();
});

// -- what is drawn

/** @type {import("./drawing.js").Act} */
const act = { change, toKind, step, showAll, measure: () => measure(), showHelp };
const draw = () => drawPage(act);

// -- begin

/** The panels of findings; a guest has none of them: they change, compare and export. */
const found = { show: () => {}, facts: /** @type {(facts: SliceFacts) => void} */ (() => {}) };
const fillFindings = () =>
  findings(byId("findings"), {
    id,
    change,
    state: () => page.state,
    ask: () => ask(first),
    point: (p) => (above.place = p),
    reload,
    measured: () => page.picked,
    outline,
    brush,
    like,
    known,
  });

async function reload() {
  page.facts = await readSliceFacts(id, page.state.source);
  draw();
  found.facts(page.facts);
}

/** Where the marked stretch of the walk is; without its times its ends. */
async function stretchOf({ mark: ends, span } = page.state) {
  const times = timesOf(span);
  const walk = times ? await readStretch(id, times).catch(() => null) : null;
  return walk?.positions_m.length ? walk.positions_m : endsOf(ends);
}

async function begin() {
  byId("above").append(above);
  draw();
  help(byId("help"));
  follow(first, second);
  follow(second, first);
  above.addEventListener("slice", (event) => {
    const ends = detailOf(event);
    const { state } = page;
    change(state.kind === "vertical" ? ends : unframed({ ...state, kind: "vertical", ...ends }));
  });
  dark.addEventListener("change", load);
  const opening = attempt(byId("message"), async () => {
    const [project, me] = await Promise.all([readProject(id), readCurrentUser()]);
    if (!isGuest(me)) Object.assign(found, fillFindings());
    only("page-head").name = project.name;
    only("map-verdict").facts = factsIn(project.summary);
    document.title = t("title-of", { project: project.name });
    if (isPlan(project)) {
      showPlan(id, project, isGuest(me));
      return true;
    }
    waitFor(t("opening-map"));
    await reload().finally(() => waitFor(""));
    above.walk = page.stretch = await stretchOf();
    const { facts, state } = page;
    if (!facts) return true;
    if (!state.given)
      page.state = { ...state, ...startOf("horizontal", state, facts.bounds_m, null), given: true };
    const { u, v, m } = page.state;
    if (u !== null && v !== null && m !== null) first.frame = { u, v, m };
    change({});
    above.show(aboveUrl(id, facts.key), await readAboveWindow(id));
    return true;
  });
  followJobs(opening);
  document.body.classList.toggle("no-slices", !(await opening) && !page.facts);
}

addEventListener("popstate", () => change(parse(location.search)));
begin();
