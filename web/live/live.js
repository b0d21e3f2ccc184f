// The operator's page of a live capture: map, coverage, warnings, controls.

import { keep, kept } from "../shared/address.js";
import { readCurrentUser } from "../shared/api.js";
import { CloudCanvas } from "../shared/cloud_canvas.js";
import { attempt, byId, say, targetOf, within } from "../shared/dom.js";
import "../shared/language_choice.js";
import { t } from "../shared/texts.js";
import { drawActions, mark, nameThePlace } from "./actions.js";
import { Camera, moveByPointer } from "./camera.js";
import { drawDance, showDance } from "./dance.js";
import { drawHealth, showHealth } from "./health.js";
import { drawOverlay, planImage } from "./overlay.js";
import { LiveScene } from "./scene.js";
import { clock, coverageTexts, hint, isCapturing, stateText } from "./captions.js";

/**
 * @import {Me} from "../shared/http_types"
 * @import {Phone, Plan} from "./messages"
 * @import {Area, Styles} from "./overlay.js"
 * @typedef {(...values: number[]) => number} Best
 */

const HEAD_M = 0.5;
const MIN_FREE_PX = 80;
const COLORS = ["path", "gap", "me", "ink", "sky", "accent", "well", "poor", "bad"];
const SUN = "recon4.live.sun";
const cloud = new CloudCanvas(byId("points", HTMLCanvasElement));
const camera = new Camera();
const overlay = byId("overlay", HTMLCanvasElement).getContext("2d");
const dark = matchMedia("(prefers-color-scheme: dark)");

/** What the page shows of the scene, and how. */
const page = {
  follow: true, // the map moves with the operator
  byHeight: false,
  ceiling: false, // what is above head height is shown
  linked: true,
  due: false, // it is drawn before the next frame
  chosen: -1, // index of the chosen gap
  me: /** @type {Me | null} */ (null),
  battery: /** @type {Phone | null} */ (null),
  whole: "", // project whose whole map was shown at the end
  fitted: false, // the whole map is shown and was not moved since
};

const scene = new LiveScene(cloud, {
  news: () => (drawTexts(), redraw()),
  link: (/** @type {boolean} */ yes, reason = "") => {
    if (reason) say(byId("message"), reason);
    if (yes === page.linked) return;
    page.linked = yes;
    if (yes) say(byId("message"), ""); // errors of requests without a link
    drawTexts();
    if (yes && !page.me)
      readCurrentUser(true).then(
        (found) => ((page.me = found), drawTexts()),
        () => {},
      );
  },
  plan: paintPlan,
});

async function paintPlan(/** @type {Plan} */ plan) {
  const { poor, well } = styles();
  const painted = await planImage(plan, [poor, well]);
  if (plan !== scene.newest.plan) return painted.bitmap.close();
  scene.plan?.bitmap.close();
  scene.plan = painted;
  redraw();
}

/** Draws everything with new colors. */
function repaint() {
  if (scene.newest.plan) paintPlan(scene.newest.plan);
  redraw();
}

/** @returns {Styles} */
function styles() {
  const style = getComputedStyle(document.body);
  return /** @type {Styles} */ (
    Object.fromEntries(COLORS.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]))
  );
}

function redraw() {
  if (!page.due) requestAnimationFrame(draw);
  page.due = true;
}

/**
 * Area of the map no bar covers, {left, top, right, bottom}, and its center [px].
 * @returns {{map: DOMRect, free: Area, middle: [number, number]}}
 */
function space() {
  const [map, top, bottom, views] = [
    byId("map"),
    within(document, ".top"),
    byId("bottom"),
    within(document, ".views"),
  ].map((one) => one.getBoundingClientRect());
  const beside = top.right <= map.left + 1; // bars beside the map, not over it
  const free = {
    left: 0,
    right: beside ? views.left - map.left : map.width,
    top: beside ? 0 : top.bottom - map.top,
    bottom: beside ? map.height : bottom.top - map.top,
  };
  if (free.bottom - free.top < MIN_FREE_PX) [free.top, free.bottom] = [0, map.height];
  return { map, free, middle: [(free.left + free.right) / 2, (free.top + free.bottom) / 2] };
}

function showWhole() {
  const planBox = scene.plan?.box;
  const boxes = [...(planBox ? [planBox] : []), ...scene.path.map((place) => [place, place])];
  if (!boxes.length) return;
  const pick = (/** @type {Best} */ best, /** @type {0 | 1} */ corner, /** @type {0 | 1} */ axis) =>
    best(...boxes.map((box) => box[corner][axis]));
  const { map, free } = space();
  const right = within(document, ".views").getBoundingClientRect().left - map.left;
  /** @type {[[number, number], [number, number]]} */
  const box = [
    [pick(Math.min, 0, 0), pick(Math.min, 0, 1)],
    [pick(Math.max, 1, 0), pick(Math.max, 1, 1)],
  ];
  camera.fit(box, { width: right - free.left, height: free.bottom - free.top });
  camera.pan((right - free.right) / 2, 0);
  press("follow", (page.follow = false));
  page.fitted = true;
}

function draw() {
  page.due = false;
  if (["finishing", "ready"].includes(scene.state) && scene.plan && page.whole !== scene.project)
    ((page.whole = scene.project), showWhole());
  const ratio = Math.min(devicePixelRatio || 1, 2);
  const {
    map: { width, height },
    free,
    middle,
  } = space();
  for (const canvas of [byId("points", HTMLCanvasElement), byId("overlay", HTMLCanvasElement)])
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio))
      [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (page.follow && scene.me) camera.target = [...scene.me.p];
  const z = scene.me?.p[2] ?? 0;
  cloud.heights = [z - 1.6, z + (page.ceiling ? 1.8 : HEAD_M)];
  cloud.draw({
    turn: camera.turn,
    target: camera.target,
    scale: [(2 * camera.pxPerM) / width, (2 * camera.pxPerM) / height],
    shift: [(2 * middle[0]) / width - 1, 1 - (2 * middle[1]) / height],
    size: Math.max(1.5, cloud.voxelM * camera.pxPerM * ratio),
    top: page.ceiling || !scene.me ? 1e6 : z + HEAD_M,
    byHeight: page.byHeight,
    ink: document.body.classList.contains("sun") || !dark.matches,
  });
  const marks = scene.marks.flatMap((one) =>
    one.what === "point" && one.p ? [{ ...one, p: one.p }] : [],
  );
  if (!overlay) return;
  drawOverlay(
    overlay,
    { width, height, ratio, middle, free },
    camera,
    { ...scene, marks, chosen: page.chosen },
    styles(),
  );
  byId("upright").hidden = Math.abs(Math.sin(camera.yaw / 2)) < 0.01;
  byId("needle").style.transform = `rotate(${camera.yaw}rad)`;
}

/**
 * Sets a text only if it has changed, so that a screen reader reads it once.
 * @param {string} id
 * @param {string} text
 */
function write(id, text) {
  if (byId(id).textContent !== text) byId(id).textContent = text;
}

function drawTexts() {
  if (scene.renewed && !document.querySelector("dialog[open]")) location.reload();
  const { state, newest } = scene;
  document.body.classList.toggle("walking", isCapturing(state));
  const { text, className } = stateText(state, page.linked);
  write("state", text);
  byId("state").className = className;
  const place = scene.marks.findLast((one) => one.what === "place")?.text;
  write("place", !state || state === "none" ? "" : (place ?? scene.project));
  const walked = newest.loop?.walked_m ? ` · ${Math.round(newest.loop.walked_m)} m` : "";
  write("time", newest.status && state !== "none" ? clock(newest.status.seconds) + walked : "");
  const { linked, battery } = page;
  drawHealth({ scene, linked, battery, drawsPoints: cloud.works });
  drawDance(newest);
  drawCoverage();
  const mayCapture = page.me?.may.includes("capture") ?? null;
  const { project } = scene;
  drawActions({ state, project, mayCapture, linked, loop: () => scene.newest.loop });
}

function drawCoverage() {
  byId("map").dataset.points = String(cloud.count);
  const { newest, state } = scene;
  byId("coverage").hidden = !newest.gaps || newest.gaps.well === null || state === "none";
  if (page.chosen >= (newest.gaps?.gaps.length ?? 0)) page.chosen = -1;
  const { well, poor, text, count, all, one } = coverageTexts(newest.gaps, page.chosen);
  write("well", well);
  write("poor", poor);
  write("gap-words", text);
  byId("gap", HTMLButtonElement).disabled = count === 0;
  byId("gap").ariaLabel = all;
  write(
    "hint",
    one ||
      (state
        ? hint(state, newest, {
            mayCapture: page.me?.may.includes("capture") ?? null,
            mapped: cloud.count > 0,
          })
        : ""),
  );
}

/**
 * @param {string} id
 * @param {boolean} yes
 */
const press = (id, yes) => byId(id).setAttribute("aria-pressed", String(yes));

function nextGap() {
  if (!scene.gaps.length) return;
  page.chosen = (page.chosen + 1) % scene.gaps.length;
  byHand(() => (camera.target = [...scene.gaps[page.chosen].p, scene.me?.p[2] ?? 0]));
  if (!scene.showPlan) views.plan();
  drawCoverage();
}

function byHand(/** @type {() => void} */ act) {
  press("follow", (page.follow = page.fitted = false));
  act();
}

function toggleFollow() {
  page.chosen = -1;
  const off = page.follow;
  if (off) showWhole();
  press("follow", (page.follow = !off));
  page.fitted &&= off;
  drawCoverage();
}

function setSun(/** @type {boolean} */ yes) {
  press("sun", document.body.classList.toggle("sun", yes));
  keep(SUN, yes ? "1" : "");
  repaint();
}

/** @type {Record<string, () => unknown>} */
const views = {
  upright: () => (camera.yaw = 0),
  tilt: () => (camera.tilt(), press("tilt", !camera.above)),
  follow: toggleFollow,
  color: () => press("color", (page.byHeight = !page.byHeight)),
  plan: () => press("plan", (scene.showPlan = !scene.showPlan)),
  sun: () => setSun(!document.body.classList.contains("sun")),
  gap: nextGap,
};
for (const [id, act] of Object.entries(views))
  byId(id).addEventListener("click", () => (act(), redraw()));

function showAll(/** @type {boolean} */ yes) {
  byId("ceiling", HTMLInputElement).checked = page.ceiling = yes;
  redraw();
}

function help() {
  const points = t("points-here", { points: scene.total });
  const who = page.me?.login ? { name: page.me.name, role: page.me.role } : null;
  byId("about").textContent = page.me ? (who ? t("signed-in", { ...who, points }) : points) : "";
  byId("name-it").hidden = !page.me?.may.includes("capture") || !isCapturing(scene.state);
  byId("dance-it").hidden = !isCapturing(scene.state) || !scene.newest.motion;
  byId("more", HTMLDialogElement).showModal();
}

const sensors = () => isCapturing(scene.state) && showHealth({ scene, battery: page.battery });

byId("help").addEventListener("click", help);
byId("sensors").addEventListener("click", sensors);
byId("name-it").addEventListener("click", nameThePlace);
byId("dance-it").addEventListener("click", () => showDance(scene.newest));
byId("ceiling").addEventListener("change", (event) => showAll(targetOf(event).checked));

/** @type {Record<string, () => unknown>} */
const KEYS = {
  t: views.tilt,
  f: views.follow,
  c: views.color,
  g: views.plan,
  s: views.sun,
  n: nextGap,
  u: views.upright,
  v: sensors,
  "?": help,
  h: () => showAll(!page.ceiling),
  m: () => scene.state === "recording" && page.me?.may.includes("capture") && mark(),
  q: () => camera.rotate(-0.2),
  e: () => camera.rotate(0.2),
  "+": () => camera.zoom(1.25),
  "-": () => camera.zoom(0.8),
  ArrowLeft: () => byHand(() => camera.pan(60, 0)),
  ArrowRight: () => byHand(() => camera.pan(-60, 0)),
  ArrowUp: () => byHand(() => camera.pan(0, 60)),
  ArrowDown: () => byHand(() => camera.pan(0, -60)),
};
addEventListener("keydown", (event) => {
  const typing = targetOf(event).closest?.("input, select, dialog");
  const act = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
  if (!act || typing || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  act();
  redraw();
});

moveByPointer(byId("overlay"), camera, {
  onMove: () => ((page.fitted = false), redraw()),
  onPan: () => page.follow && press("follow", (page.follow = false)),
  following: () => page.follow && scene.me !== null,
  middle: () => space().middle,
});

/** Keeps the screen on, so that warnings are visible, where the browser supports it. */
const stayAwake = () => document.hidden || navigator.wakeLock?.request("screen").catch(() => {});
stayAwake();
document.addEventListener("visibilitychange", stayAwake);
navigator.getBattery?.().then(
  (found) => (page.battery = found),
  () => {},
);
for (const bar of [byId("bottom"), within(document, ".top")])
  new ResizeObserver(redraw).observe(bar);
new ResizeObserver(() => (page.fitted && showWhole(), redraw())).observe(byId("map"));
dark.addEventListener("change", repaint);
setInterval(() => page.linked || drawTexts(), 1000); // updates the duration of a lost link
if (kept(SUN)) setSun(true);

page.me = (await attempt(byId("message"), readCurrentUser)) ?? null;
drawTexts();
