// The page of the map: the delivered points in 3-D. The address of the page is the state.

import { idHere, leaveMap } from "../shared/address.js";
import { isGuest, readCurrentUser, readMapWalk, readProject } from "../shared/api.js";
import { attempt, byId, only, render, say, showError, svg } from "../shared/dom.js";
import { decimal, t } from "../shared/texts.js";
import { factsIn } from "../shared/verdict.js";
import "../shared/map_verdict.js";
import "../shared/page_head.js";
import { openShare } from "../shared/share.js";
import { aimOf } from "./aim.js";
import { drawBar } from "./bar.js";
import { compareOf, drawDivider } from "./compare.js";
import { between, panned, pixelM, rayAt, zoomed } from "./camera.js";
import { moveByGestures } from "./controls.js";
import { flightOf } from "./flying.js";
import { handlesIn } from "./handles.js";
import { listenToKeys } from "./keys.js";
import { markingOf } from "./marking.js";
import { drawHelp, drawStatus } from "./caption.js";
import { dark, drawingOf, hideOpening, opened, run, storedOf } from "./opening.js";
import { overlay } from "./overlay.js";
import * as shown from "./page.js";
import { notesOf } from "./notes.js";
import { drawPanel } from "./panel.js";
import { lineOf, timesOf } from "./places.js";
import { drawProfile, profileOf } from "./profile.js";
import { followJobs, takeNews } from "./rebuilt.js";
import { savedOf, share } from "./saved.js";
import { all, first, seenOn } from "./sight.js";
import { format, parse } from "./state.js";
import {
  canceled,
  choose,
  clicked,
  dragged,
  face,
  finish,
  finishHere,
  target,
  undoPoint,
} from "./tools.js";
import { togglesOf } from "./toggles.js";
import { VIEWS } from "./views.js";
import { withoutPoints } from "./without_points.js";
import { downloadMeasurements } from "./measured_panel.js";
import { askVolumes, volumeOf } from "./volumes.js";

/**
 * @import {Camera} from "./camera.js"
 * @import {Measurement} from "./measure.js"
 * @import {MapState} from "./state.js"
 */

const { page } = shown;
const id = idHere();
const calm = matchMedia("(prefers-reduced-motion: reduce)");
const TURN_MS = 450;
const ADDRESS_MS = 250;
const place = () => byId("map", HTMLCanvasElement);
const screen = () => run.canvas?.screen ?? { width: 1, height: 1 };
const seen = () => seenOn(screen());
const camera = () => page.state.camera ?? first(seen());

/** Changes the state, the address, and what depends on them. */
function change(/** @type {Partial<MapState>} */ next) {
  const color = shown.colorShown();
  Object.assign(page.state, next);
  if (next.camera) say(byId("message"), ""); // what was refused is asked again
  if (next.cutCeiling && page.index) page.state.clip.heights = shown.usualHeights(page.index);
  if (run.canvas && shown.colorShown() !== color) {
    run.canvas.tiles.color(storedOf()).catch(showProblem);
    compare.color();
  }
  draw();
  clearTimeout(run.address);
  run.address = setTimeout(
    () => history.replaceState(null, "", `?${format(page.state)}`),
    ADDRESS_MS,
  );
}

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
  if (!run.canvas) return;
  document.body.classList.toggle("with-tool", page.tool !== "");
  document.body.classList.toggle("with-panel", page.panel);
  drawBar(byId("bar"), act); // the map is fitted below it
  run.canvas.drawing = drawingOf(camera());
  drawPanel(byId("panel"), act);
  drawProfile(byId("profile"), profile);
  drawDivider(byId("divider"), act);
  askVolumes(draw);
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
      pins: shown.pinsShown(),
      chosen: page.chosen,
      times: state.mark ? timesOf(state.mark) : "",
      stretch: state.mark ? lineOf(state.mark, page.walk) : [],
      drag: drag ?? aim.dragShown(),
      brush: page.brush,
      boxes: page.like.boxes,
      aim: page.aim.on,
      tool,
      volumeOf,
    },
  );
  const over = /** @type {unknown} */ (document.getElementById("overlay"));
  render(svg`${content}`, /** @type {HTMLElement} */ (over));
  drawHandles();
}

function drawCaption() {
  if (!run.canvas) return;
  const { points, rested } = run.canvas.drawn;
  hideOpening(run.canvas);
  const meters = 100 * pixelM(camera(), screen());
  const length = meters < 1 ? `${decimal(100 * meters, 1)} cm` : `${decimal(meters, 2)} m`;
  const scale = `100 px = ${length}`;
  drawStatus(byId("status"), { points, rested, scale }, act);
}

const showProblem = (/** @type {unknown} */ error) => showError(byId("message"), error);

// -- what people do

const stage = {
  camera,
  screen,
  seen,
  change,
  flyTo,
  draw,
  under,
  view: (/** @type {string} */ name, /** @type {boolean} */ parallel) => view(name, parallel),
  stop: () => cancelAnimationFrame(run.turn),
};
const { fly, seek } = flightOf(stage);
const drawHandles = handlesIn(byId("handles"), stage);
const toggles = togglesOf(change);
const marking = markingOf(stage);
const notes = notesOf(draw, () => ({ camera: camera(), screen: screen() }));
const saved = savedOf(draw);
const compare = compareOf({
  change,
  draw,
  canvas: () => run.canvas,
  values: () => storedOf(),
});
const profile = profileOf({ draw, dark: () => dark.matches, change: widened });

function view(/** @type {string} */ name, parallel = camera().parallel) {
  change({ standing: false });
  flyTo(all({ ...VIEWS[name], parallel }, seen()));
}

/** All that is shown, seen from where the camera looks. */
function fit() {
  change({ standing: false });
  flyTo(all(camera(), seen()));
}

/**
 * A profile with another width, also in the list.
 * @param {Measurement} of
 * @param {number} width
 */
function widened(of, width) {
  const next = { ...of, figure: width };
  const { measurements } = page.state;
  change({ measurements: measurements.map((one) => (one.points === of.points ? next : one)) });
  return next;
}

function open(/** @type {string} */ query) {
  const next = parse(query);
  change(next);
  compare.show();
}

const goTo = (/** @type {number[]} */ p) =>
  flyTo({ ...camera(), target: [p[0], p[1], p[2]], distance: Math.min(camera().distance, 6) });

const aim = aimOf(stage, click);

/** A click: on a pin if no tool is chosen, else on the map. */
function click(/** @type {number[]} */ at) {
  const pin = page.tool === "" ? marking.pinUnder(at) : undefined;
  if (pin) return marking.choosePin(pin);
  clicked(at, { ...stage, note: notes.place, profile: profile.show }).catch(showProblem);
}

/** @type {import("./bar.js").Act} */
const act = {
  view,
  fit,
  fly,
  seek,
  share: () => attempt(byId("message"), share).then(draw),
  invite: () => attempt(byId("message"), () => openShare(id, () => format(page.state))),
  save: (name) => attempt(byId("message"), () => saved.keep(name)),
  open,
  forget: (view) => attempt(byId("message"), () => saved.remove(view)),
  notes,
  profile,
  compare,
  csv: () => void downloadMeasurements().catch(showProblem),
  change,
  goTo,
  choosePin: marking.choosePin,
  parallel: () =>
    change({ camera: { ...camera(), parallel: !camera().parallel }, standing: false }),
  tool: (tool, kind) => choose(tool, stage, kind),
  faceSection: () => face(stage),
  snapping: () => {
    page.snapping = !page.snapping;
    page.reading = t(page.snapping ? "picks-snap" : "picks-do-not-snap");
    draw();
  },
  whole: () =>
    document.fullscreenElement
      ? document.exitFullscreen()
      : document.querySelector("main")?.requestFullscreen(),
  panel: () => {
    page.panel = !page.panel;
    draw();
  },
  help: () => byId("help", HTMLDialogElement).showModal(),
  finish: () => void finish(stage).catch(showProblem),
  undoPoint: () => void undoPoint(stage),
  end,
  toMap: () => place().focus({ preventScroll: true }),
};

/** Ends any tool, the flight, what is being measured. */
function end() {
  page.flight.on = false;
  if (page.tool) choose("", stage);
  Object.assign(page, { reading: "", draft: [], drag: null, chosen: null, profile: null });
  change({ standing: false, mark: null });
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
    dragging: () => ["box", "section", "brush"].includes(page.tool),
    move,
    under,
    click,
    finish: act.finish,
    drag: (from, to, done) => dragged(from, to, { ...stage, done }),
    cancel: () => canceled(stage),
  });
  place().addEventListener("dblclick", (event) => {
    if (page.tool === "") target([event.offsetX, event.offsetY], stage).catch(showProblem);
    else finishHere(stage).catch(showProblem);
  });
  dark.addEventListener("change", draw);
  listenToKeys(act, {
    ...toggles,
    step,
    press: aim.press,
    zoom: (times) => move(zoomed(camera(), times)),
  });
  place().addEventListener("pointerdown", aim.end);
  addEventListener("popstate", () => open(location.search));
  if (!page.guest) addEventListener("focus", () => notes.read().catch(showProblem)); // by others
  only("map-verdict").addEventListener("click", marking.followLinks);
}

/** The server answers again: what it did not say is asked again. */
function answersAgain() {
  say(byId("message"), "");
  run.canvas?.tiles.again();
}

async function begin() {
  drawHelp(byId("help"));
  const [project, me] = await Promise.all([readProject(id), readCurrentUser()]);
  const [mayShare, mayProcess] = [me.may.includes("share"), me.may.includes("process")];
  Object.assign(page, { project, guest: isGuest(me), mayShare, mayProcess });
  only("page-head").name = project.name;
  only("map-verdict").facts = factsIn(project.summary);
  document.title = t("title-of", { project: project.name });
  const stages = project.stages.map(({ stage: name }) => name);
  if (!stages.includes("map")) return withoutPoints(stages);
  const { canvas, sampled } = await opened;
  canvas.onDrawn = drawCaption;
  canvas.tiles.onProblem = showProblem;
  new ResizeObserver(draw).observe(place());
  listen();
  if (takeNews()) page.reading = t("new-map-shown");
  if (!page.guest) followJobs(byId("news"), answersAgain);
  draw();
  canvas.refine();
  addEventListener("pagehide", () => leaveMap(id, format(page.state)));
  act.toMap();
  await sampled;
  const lists = page.guest
    ? []
    : [notes, saved, compare].map((one) => one.read().catch(showProblem));
  const [walk] = await Promise.all([readMapWalk(id), ...lists]);
  page.walk = walk;
  canvas.layers(walk.positions_m, walk.nodes_m);
  if (page.state.mark && !page.state.camera) marking.mark(page.state.mark);
  draw();
}

attempt(byId("message"), begin);
/** For tests: the camera. */
Object.assign(/** @type {any} */ (window).recon4Map, { camera, move });
