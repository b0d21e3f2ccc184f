// The page of the map: the delivered points in 3-D. The address of the page is the state.

import { idHere } from "../shared/address.js";
import { pointReader, projectUrl, readMapIndex, readMapWalk, readProject } from "../shared/api.js";
import { attempt, byId, html, only, render, say, showError, svg } from "../shared/dom.js";
import { factsIn } from "../shared/verdict.js";
import "../shared/map_verdict.js";
import "../shared/page_head.js";
import { drawBar, drawHelp, drawStatus } from "./bar.js";
import { between, panned, pixelM, rayAt, zoomed } from "./camera.js";
import { moveByGestures } from "./controls.js";
import { positionAt, standingAt, walking } from "./flight.js";
import { listenToKeys } from "./keys.js";
import { MapCanvas } from "./map_canvas.js";
import { toCsv } from "./measure.js";
import { overlay } from "./overlay.js";
import * as shown from "./page.js";
import { drawPanel } from "./panel.js";
import { format, parse } from "./state.js";
import { choose, clicked, dragged, face, finish, target } from "./tools.js";
import { VIEWS, savedViews, saveViews, viewOf } from "./views.js";

/**
 * @import {Camera} from "./camera.js"
 * @import {MapState} from "./state.js"
 */

const { page } = shown;
const id = idHere();
const dark = matchMedia("(prefers-color-scheme: dark)");
const calm = matchMedia("(prefers-reduced-motion: reduce)");
const TURN_MS = 450;
const ADDRESS_MS = 250;
const PANEL_PX = 320;
const NAME_AGAIN_MS = 1500;
/** What runs: the canvas, the timer of the address, the turn of the camera. */
const run = { canvas: /** @type {MapCanvas | null} */ (null), address: 0, turn: 0, flown: 0 };
const place = () => byId("map", HTMLCanvasElement);
const screen = () => run.canvas?.screen ?? { width: 1, height: 1 };
const camera = () => page.state.camera ?? all("oblique", false);

/**
 * All of the map from where a named view looks.
 * @param {string} name
 * @param {boolean} parallel
 */
const all = (name, parallel) => fitted(VIEWS[name], parallel);

/**
 * All of the map beside the panel, seen from there.
 * @param {{yaw: number, pitch: number}} look
 * @param {boolean} parallel
 */
function fitted(look, parallel) {
  const { index } = page;
  if (!index) throw new Error("the map has not been read");
  const { width, height } = screen();
  const covered = page.panel && width > 2 * PANEL_PX ? PANEL_PX : 0;
  const free = { width: width - covered, height };
  const made = viewOf(look, { index, screen: free, heights: shown.heightsShown(), parallel });
  return panned(made, screen(), [-covered / 2, 0]);
}

/** Changes the state, the address, and what depends on them. */
function change(/** @type {Partial<MapState>} */ next) {
  const color = shown.colorShown();
  Object.assign(page.state, next);
  if (next.camera) say(byId("message"), ""); // what was refused is asked again
  if (next.cutCeiling && page.index) page.state.clip.heights = shown.usualHeights(page.index);
  if (run.canvas && shown.colorShown() !== color)
    run.canvas.tiles.color(storedOf(shown.colorShown())).catch(showProblem);
  draw();
  clearTimeout(run.address);
  run.address = setTimeout(
    () => history.replaceState(null, "", `?${format(page.state)}`),
    ADDRESS_MS,
  );
}

const storedOf = (/** @type {string} */ color) =>
  /** @type {import("./tiles.js").Stored | ""} */ (
    page.index?.columns.find(({ name }) => name === color)?.name ?? ""
  );

const move = (/** @type {Camera} */ next) => {
  cancelAnimationFrame(run.turn);
  change({ camera: next });
};

/** Moves the camera there, at once if the system asks for less motion. */
function flyTo(/** @type {Camera} */ goal) {
  page.flight.on = false;
  cancelAnimationFrame(run.turn);
  const [from, began] = [camera(), performance.now()];
  const step = () => {
    const part = Math.min(1, (performance.now() - began) / TURN_MS);
    const eased = part * part * (3 - 2 * part);
    if (part >= 1 || calm.matches) return change({ camera: goal });
    change({ camera: { ...between(from, goal, eased), parallel: from.parallel && goal.parallel } });
    run.turn = requestAnimationFrame(step);
  };
  step();
}

// -- what is drawn

function draw() {
  const { index, state } = page;
  if (!index || !run.canvas) return;
  run.canvas.drawing = {
    camera: camera(),
    color: shown.colorShown(),
    ends: shown.endsShown().ends,
    planes: shown.planes(),
    depth: state.depth,
    size: state.size,
    dark: dark.matches,
    layers: { walk: state.layers.includes("walk"), nodes: state.layers.includes("nodes") },
  };
  document.body.classList.toggle("with-tool", page.tool !== "");
  document.body.classList.toggle("with-panel", page.panel);
  drawBar(byId("bar"), act);
  drawPanel(byId("panel"), act);
  drawOver();
  drawCaption();
}

function drawOver() {
  const { state, draft, drag, tool } = page;
  const content = overlay(
    { camera: camera(), screen: screen() },
    {
      measurements: state.measurements,
      draft: draft.map(({ p }) => p),
      clip: state.clip,
      heights: shown.heightsShown(),
      findings: state.layers.includes("findings") ? shown.findingPlaces() : [],
      drag,
      tool,
    },
  );
  const over = /** @type {unknown} */ (document.getElementById("overlay"));
  render(svg`${content}`, /** @type {HTMLElement} */ (over));
}

function drawCaption() {
  if (!run.canvas) return;
  const { points, rested } = run.canvas.drawn;
  const meters = 100 * pixelM(camera(), screen());
  const length = meters < 1 ? `${(100 * meters).toFixed(1)} cm` : `${meters.toFixed(2)} m`;
  const scale = `100 px = ${length}`;
  drawStatus(byId("status"), { points, rested, scale });
}

const showProblem = (/** @type {unknown} */ error) => showError(byId("message"), error);

// -- what people do

const stage = {
  camera,
  screen,
  change,
  flyTo,
  draw,
  view: (/** @type {string} */ name, /** @type {boolean} */ parallel) => view(name, parallel),
};

function view(/** @type {string} */ name, parallel = camera().parallel) {
  change({ standing: false });
  flyTo(all(name, parallel));
}

/** All of the map, seen from where the camera looks. */
function fit() {
  const { parallel } = camera();
  change({ standing: false });
  flyTo(fitted(camera(), parallel));
}

function walkOn() {
  const { flight, walk, state } = page;
  const last = walk?.t_s.at(-1) ?? 0;
  if (!flight.on || !walk || flight.time >= last) {
    flight.on = false;
    return draw();
  }
  const now = performance.now();
  flight.time = Math.min(last, flight.time + ((now - run.flown) / 1000) * flight.speed);
  run.flown = now;
  change({ camera: walking(walk, flight.time, state.camera ?? camera()), standing: true });
  requestAnimationFrame(walkOn);
}

function fly() {
  const { flight, walk } = page;
  if (!walk?.t_s.length) return;
  cancelAnimationFrame(run.turn);
  flight.on = !flight.on;
  run.flown = performance.now();
  if (flight.time >= (walk.t_s.at(-1) ?? 0)) flight.time = 0;
  seek(flight.time);
  walkOn();
}

/** Stands on the walk at a time. */
function seek(/** @type {number} */ time) {
  const { walk, state } = page;
  if (!walk) return;
  page.flight.time = time;
  const { target: to } = walking(walk, time, camera());
  const here = positionAt(walk, time);
  const yaw = Math.atan2(to[0] - here[0], to[1] - here[1]);
  const clip = { ...state.clip, heights: /** @type {[null, null]} */ ([null, null]) };
  change({ camera: standingAt(here, yaw, -0.08), standing: true, clip, cutCeiling: false });
}

async function share() {
  history.replaceState(null, "", `?${format(page.state)}`);
  // Browsers have a clipboard on https and on this computer only.
  await navigator.clipboard?.writeText(location.href);
  page.reading = navigator.clipboard
    ? "The link to this view is copied"
    : "The address of this page is the link to this view: copy it there";
  draw();
}

function csv() {
  const text = toCsv(page.state.measurements, page.index?.crs ?? "");
  const file = document.createElement("a");
  file.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  file.download = `${id}-measurements.csv`;
  file.click();
  setTimeout(() => URL.revokeObjectURL(file.href), NAME_AGAIN_MS);
}

function save() {
  const name = `View ${page.saved.length + 1}, ${new Date().toLocaleString()}`;
  page.saved = [...page.saved, { name, query: format(page.state) }];
  saveViews(id, page.saved);
  draw();
}

function forget(/** @type {string} */ name) {
  page.saved = page.saved.filter((one) => one.name !== name);
  saveViews(id, page.saved);
  draw();
}

function open(/** @type {string} */ query) {
  const next = parse(query);
  change(next);
}

const goTo = (/** @type {number[]} */ p) =>
  flyTo({ ...camera(), target: [p[0], p[1], p[2]], distance: Math.min(camera().distance, 6) });

function nextColor() {
  if (!page.index) return;
  const able = shown.colorsOf(page.index);
  const next = able[(able.indexOf(shown.colorShown()) + 1) % able.length];
  change({ color: next, lo: null, hi: null });
}

function ceilings() {
  const { clip, cutCeiling } = page.state;
  if (!cutCeiling) return change({ cutCeiling: true });
  change({ cutCeiling: false, clip: { ...clip, heights: [null, null] } });
}

const toggleWalk = () => {
  const { layers } = page.state;
  const without = layers.filter((one) => one !== "walk");
  change({ layers: without.length < layers.length ? without : [...layers, "walk"] });
};

/** @type {import("./bar.js").Act} */
const act = {
  view,
  fit,
  fly,
  seek,
  share: () => attempt(byId("message"), share),
  save,
  open,
  forget,
  csv,
  change,
  goTo,
  parallel: () =>
    change({ camera: { ...camera(), parallel: !camera().parallel }, standing: false }),
  tool: (tool, kind) => choose(tool, stage, kind),
  faceSection: () => face(stage),
  whole: () =>
    document.fullscreenElement
      ? document.exitFullscreen()
      : document.querySelector("main")?.requestFullscreen(),
  panel: () => {
    page.panel = !page.panel;
    draw();
  },
  help: () => byId("help", HTMLDialogElement).showModal(),
};

/** Ends any tool, the flight, what is being measured. */
function end() {
  page.flight.on = false;
  if (page.tool) choose("", stage);
  Object.assign(page, { reading: "", draft: [], drag: null });
  change({ standing: false });
}

/** Moves by a part of the image. */
const step = (/** @type {number} */ x, /** @type {number} */ y) => {
  const { width, height } = screen();
  move(panned(camera(), screen(), [(-x * width) / 10, (y * height) / 10]));
};

// -- begin

/** Distance from the eye to what was drawn under a pixel, as a point; null = nothing was. */
function under(/** @type {number[]} */ at) {
  const ray = rayAt(camera(), screen(), at);
  const pixel = pixelM(camera(), screen());
  const cone = camera().parallel
    ? { tan: 0, least: 6 * pixel }
    : { tan: (6 * pixel) / camera().distance, least: 0.01 };
  const depth = run.canvas?.tiles.along(ray, { ...cone, planes: shown.planes() }) ?? null;
  return depth === null ? null : [0, 1, 2].map((k) => ray.origin[k] + depth * ray.direction[k]);
}

function listen() {
  moveByGestures(place(), {
    camera,
    screen,
    standing: () => page.state.standing,
    dragging: () => page.tool === "box" || page.tool === "section",
    move,
    under,
    click: (at) => clicked(at, stage).catch(showProblem),
    drag: (from, to, done) => dragged(from, to, { ...stage, done }),
    cancel: () => {
      page.drag = null;
      draw();
    },
  });
  place().addEventListener("dblclick", (event) => {
    if (page.tool === "") target([event.offsetX, event.offsetY], stage).catch(showProblem);
  });
  dark.addEventListener("change", draw);
  listenToKeys(act, {
    color: nextColor,
    ceilings,
    walk: toggleWalk,
    end,
    step,
    finish: () => finish(stage).catch(showProblem),
    zoom: (times) => move(zoomed(camera(), times)),
  });
  addEventListener("popstate", () => open(location.search));
}

async function begin() {
  drawHelp(byId("help"));
  page.saved = savedViews(id);
  const project = await readProject(id);
  page.project = project;
  only("page-head").name = project.name;
  only("map-verdict").facts = factsIn(project.summary);
  document.title = `Map · ${project.name} · recon4`;
  if (!project.stages.some(({ stage: name }) => name === "map"))
    return say(
      byId("message"),
      html`This project has no points in 3-D. <a href=${projectUrl(id)}>Its page</a> shows what
        there is.`,
    );
  const index = (page.index = await readMapIndex(id));
  if (page.state.cutCeiling) page.state.clip.heights = shown.usualHeights(index);
  run.canvas = new MapCanvas(place(), index, pointReader(id, index.key));
  run.canvas.onDrawn = drawCaption;
  run.canvas.tiles.onProblem = showProblem;
  new ResizeObserver(draw).observe(place());
  listen();
  draw();
  place().focus({ preventScroll: true });
  await run.canvas.tiles.readSample(storedOf(shown.colorShown()));
  const walk = (page.walk = await readMapWalk(id));
  run.canvas.layers(walk.positions_m, walk.nodes_m);
  draw();
}

attempt(byId("message"), begin);
/** For tests: what is shown and drawn. */
Object.assign(window, { recon4Map: { page, run, camera, move } });
