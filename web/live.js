// The operator's page: is everything captured?

import { readMe } from "./api.js";
import { CloudCanvas } from "./cloud_canvas.js";
import { attempt, fill, make } from "./dom.js";
import { drawActions, mark, nameThePlace } from "./live_actions.js";
import { Camera, moveByPointer } from "./live_camera.js";
import { drawOverlay, planPicture } from "./live_overlay.js";
import { LiveScene } from "./live_scene.js";
import { clock, coverageWords, hint, sensorWords, stateWords } from "./live_words.js";

const HEAD_M = 0.5;
const COLORS = ["path", "gap", "me", "ink", "sky", "accent", "well", "poor"];
const byId = (id) => document.getElementById(id);
const cloud = new CloudCanvas(byId("points"));
const camera = new Camera();
const overlay = byId("overlay").getContext("2d");
const dark = matchMedia("(prefers-color-scheme: dark)");
let [follow, byHeight, ceiling, linked, due] = [true, false, false, true, false];
let chosen = -1; // of the gaps
let me = null; // who looks
let battery = null;

const scene = new LiveScene(cloud, {
  news: () => (drawWords(), redraw()),
  link: (yes) => {
    if (yes === linked) return;
    linked = yes;
    drawWords();
  },
  plan: paintPlan,
});

async function paintPlan(plan) {
  const { poor, well } = styles();
  scene.plan = await planPicture(plan, [poor, well]);
  redraw();
}

/** The colors are others now. */
function repaint() {
  if (scene.plan) paintPlan(scene.newest.plan);
  redraw();
}

function styles() {
  const style = getComputedStyle(document.body);
  return Object.fromEntries(COLORS.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

function redraw() {
  if (!due) requestAnimationFrame(draw);
  due = true;
}

function draw() {
  due = false;
  const ratio = Math.min(devicePixelRatio || 1, 2);
  const { clientWidth: width, clientHeight: height } = byId("map");
  for (const canvas of [byId("points"), byId("overlay")])
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio))
      [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (follow && scene.me) camera.target = [...scene.me.p];
  const z = scene.me?.p[2] ?? 0;
  cloud.heights = [z - 1.6, z + (ceiling ? 1.8 : HEAD_M)];
  cloud.draw({
    turn: camera.turn,
    target: camera.target,
    scale: [(2 * camera.pxPerM) / width, (2 * camera.pxPerM) / height],
    size: Math.max(1.5, cloud.voxelM * camera.pxPerM * ratio),
    top: ceiling || !scene.me ? 1e6 : z + HEAD_M,
    byHeight,
    ink: document.body.classList.contains("sun") || !dark.matches,
  });
  const foot = byId("bottom").getBoundingClientRect().top - byId("map").getBoundingClientRect().top;
  const marks = scene.marks.filter((one) => one.what === "point" && one.p);
  drawOverlay(overlay, { width, height, ratio, foot }, camera, { ...scene, marks, chosen }, styles());
}

function drawWords() {
  const { state, newest } = scene;
  const { words, look } = stateWords(state, linked);
  byId("state").textContent = words;
  byId("state").className = look;
  const place = scene.marks.findLast((one) => one.what === "place")?.text;
  byId("place").textContent = state === "none" ? "" : place ?? scene.project;
  const walked = newest.loop?.walked_m ? ` · ${Math.round(newest.loop.walked_m)} m` : "";
  byId("time").textContent = newest.status && state !== "none" ? clock(newest.status.seconds) + walked : "";
  fill(byId("sensors"), ...sensorWords(newest, state, battery).map(({ words: said, bad }) => make("li", { className: bad ? "bad" : "" }, said)));
  const warnings = cloud.works ? (newest.words ?? []) : [...(newest.words ?? []), { level: "info", text: "This browser cannot draw points (no WebGL 2); plan, way and warnings work" }];
  fill(byId("words"), ...warnings.slice(0, 3).map((word) => make("li", { className: word.level }, word.text)));
  drawCoverage();
  const mayCapture = me?.may.includes("capture") ?? null;
  drawActions({ state, project: scene.project, mayCapture, linked, loop: () => scene.newest.loop });
}

function drawCoverage() {
  byId("map").dataset.points = cloud.count;
  const { newest, state } = scene;
  byId("coverage").hidden = !newest.gaps || newest.gaps.well === null || state === "none";
  if (chosen >= (newest.gaps?.gaps.length ?? 0)) chosen = -1;
  const { well, poor, words, count, all, one } = coverageWords(newest.gaps, chosen);
  byId("well").textContent = well;
  byId("poor").textContent = poor;
  byId("gap-words").textContent = words;
  byId("gap").disabled = count === 0;
  byId("gap").ariaLabel = all;
  byId("hint").textContent = one || (state ? hint(state, newest, me?.may.includes("capture") ?? null) : "");
}

const press = (id, yes) => byId(id).setAttribute("aria-pressed", String(yes));

function nextGap() {
  if (!scene.gaps.length) return;
  chosen = (chosen + 1) % scene.gaps.length;
  byHand(() => (camera.target = [...scene.gaps[chosen].p, scene.me?.p[2] ?? 0]));
  if (!scene.showPlan) views.plan();
  drawCoverage();
}

function byHand(act) {
  press("follow", (follow = false));
  act();
}

const views = {
  tilt: () => (camera.tilt(), press("tilt", !camera.above)),
  follow: () => ((chosen = -1), press("follow", (follow = !follow)), drawCoverage()),
  color: () => ((byHeight = !byHeight), (byId("color").textContent = byHeight ? "Height" : "Intensity")),
  plan: () => press("plan", (scene.showPlan = !scene.showPlan)),
  sun: () => (press("sun", document.body.classList.toggle("sun")), repaint()),
  gap: nextGap,
};
for (const [id, act] of Object.entries(views)) byId(id).addEventListener("click", () => (act(), redraw()));

function showAll(yes) {
  byId("ceiling").checked = ceiling = yes;
  redraw();
}

function help() {
  byId("about").textContent = me ? `${me.login ? `Signed in as ${me.name}, ${me.role}. ` : ""}${scene.total.toLocaleString("en")} points on this phone.` : "";
  byId("name-it").hidden = !me?.may.includes("capture") || !["recording", "paused"].includes(scene.state);
  byId("more").showModal();
}

byId("help").addEventListener("click", help);
byId("name-it").addEventListener("click", nameThePlace);
byId("ceiling").addEventListener("change", (event) => showAll(event.target.checked));

const KEYS = {
  t: views.tilt, f: views.follow, c: views.color, g: views.plan, s: views.sun, n: nextGap, "?": help,
  h: () => showAll(!ceiling),
  m: () => scene.state === "recording" && me?.may.includes("capture") && mark(),
  "+": () => camera.zoom(1.25), "-": () => camera.zoom(0.8),
  ArrowLeft: () => byHand(() => camera.pan(60, 0)), ArrowRight: () => byHand(() => camera.pan(-60, 0)),
  ArrowUp: () => byHand(() => camera.pan(0, 60)), ArrowDown: () => byHand(() => camera.pan(0, -60)),
};
addEventListener("keydown", (event) => {
  const typing = event.target.closest?.("input, select, dialog");
  const act = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
  if (!act || typing || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  act();
  redraw();
});

moveByPointer(byId("overlay"), camera, {
  onMove: redraw,
  onHand: (panned) => panned && follow && press("follow", (follow = false)),
});

/** A dark phone shows no warnings; where this is not possible the phone darkens as it always does. */
const stayAwake = () => document.hidden || navigator.wakeLock?.request("screen").catch(() => {});
stayAwake();
document.addEventListener("visibilitychange", stayAwake);
navigator.getBattery?.().then((found) => (battery = found), () => {});
new ResizeObserver(redraw).observe(byId("map"));
new ResizeObserver(redraw).observe(byId("bottom"));
dark.addEventListener("change", repaint);

me = (await attempt(byId("message"), readMe)) ?? null;
drawWords();
