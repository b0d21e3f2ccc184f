// The operator's page: is everything captured?

import { markHere, projectUrl, readChoices, readMe, startCapture, steerCapture } from "./api.js";
import { CloudCanvas } from "./cloud_canvas.js";
import { attempt, fill, make } from "./dom.js";
import { Camera, moveByPointer } from "./live_camera.js";
import { drawOverlay, planPicture } from "./live_overlay.js";
import { LiveScene } from "./live_scene.js";

const byId = (id) => document.getElementById(id);
const cloud = new CloudCanvas(byId("points"));
const camera = new Camera();
const overlay = byId("overlay").getContext("2d");
const STATES = { none: "Nothing is recorded", recording: "Recording", paused: "Paused", finishing: "Finishing", ready: "Ready" };
let [follow, byHeight, linked, mayCapture, due] = [true, false, true, false, false];

const scene = new LiveScene(cloud, {
  news: () => (drawWords(), redraw()),
  link: (yes) => {
    if (yes !== linked) (linked = yes), drawWords();
  },
  plan: async (plan) => {
    scene.plan = await planPicture(plan);
    redraw();
  },
});

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
  cloud.heights = [z - 1.6, z + 1.8];
  cloud.draw({
    turn: camera.turn,
    target: camera.target,
    scale: [(2 * camera.pxPerM) / width, (2 * camera.pxPerM) / height],
    size: Math.max(1.5, cloud.voxelM * camera.pxPerM * ratio),
    byHeight,
    ink: document.body.classList.contains("sun") || matchMedia("(prefers-color-scheme: light)").matches,
  });
  const style = getComputedStyle(document.body);
  const styles = Object.fromEntries(["path", "gap", "me", "ink", "sky", "accent"].map((n) => [n, style.getPropertyValue(`--${n}`)]));
  const shown = { ...scene, marks: scene.marks.filter((mark) => !mark.hidden) };
  drawOverlay(overlay, { width, height, ratio }, camera, shown, styles);
}

function clock(seconds) {
  const s = Math.floor(seconds);
  const pad = (n) => String(n).padStart(2, "0");
  return s >= 3600 ? `${Math.floor(s / 3600)}:${pad(Math.floor(s / 60) % 60)}:${pad(s % 60)}` : `${Math.floor(s / 60)}:${pad(s % 60)}`;
}

function drawWords() {
  const { state, newest } = scene;
  const status = newest.status;
  byId("state").textContent = linked ? STATES[state] ?? "Connecting" : "No link. The recording goes on";
  byId("state").className = !linked ? "bad" : state === "recording" ? "on" : "";
  byId("time").textContent = status && state !== "none" ? clock(status.seconds) : "";
  fill(byId("sensors"), ...sensorChips(newest, status));
  fill(byId("words"), ...(newest.words ?? []).slice(0, 3).map((word) => make("li", { className: word.level }, word.text)));
  byId("hint").textContent = state === "none" ? "" : hint(newest);
  drawActions(state);
}

function sensorChips(newest, status) {
  if (!status || scene.state === "ready") return [];
  const chips = Object.entries(newest.rates ?? {})
    .filter(([name, rate]) => name !== "GNSS" || rate > 0)
    .map(([name, rate]) => make("li", { className: rate < 1 ? "bad" : "" }, rate < 1 ? `${name}: silent` : `${name} ${Math.round(rate)}/s`));
  const fix = newest.fix && { 1: "single", 2: "DGNSS", 4: "RTK fixed", 5: "RTK float" }[newest.fix.quality];
  if (fix) chips.push(make("li", {}, newest.fix.sd_m ? `GNSS ${fix} ±${Math.round(100 * newest.fix.sd_m[0])} cm` : `GNSS ${fix}`));
  const left = status.disk.left_s;
  if (left !== null) chips.push(make("li", { className: left < 600 ? "bad" : "" }, `disk ${left > 7200 ? `${Math.floor(left / 3600)} h` : `${Math.floor(left / 60)} min`}`));
  if (battery) chips.push(make("li", { className: battery.level < 0.15 ? "bad" : "" }, `phone ${Math.round(100 * battery.level)} %`));
  return chips;
}

function hint(newest) {
  const { gaps, loop } = newest;
  const parts = [];
  if (gaps?.gaps.length) parts.push(`${gaps.gaps.length} ${gaps.gaps.length === 1 ? "place" : "places"} not seen yet`);
  else if (gaps && gaps.well !== null) parts.push("No gaps near your way");
  if (gaps?.well) parts.push(`${Math.round(100 * gaps.well)} % of the walls seen well`);
  if (loop?.walked_m > 5)
    parts.push(loop.closed ? "loop closed" : loop.start_m < 4 ? "at the start, loop not closed yet" : `return to the start (${Math.round(loop.start_m)} m)`);
  return parts.join(" · ");
}

let shownActions = "";
function drawActions(state) {
  const key = `${state}/${mayCapture}/${scene.project}`;
  if (key === shownActions) return;
  shownActions = key;
  const button = (words, className, onclick) => make("button", { type: "button", className, onclick }, words);
  const steer = (what) => () => attempt(byId("message"), () => steerCapture(what));
  const rows = {
    none: [button("Start…", "primary", begin)],
    recording: [button("Mark", "", note), button("Pause", "", steer("pause")), button("Stop", "stop", stop)],
    paused: [button("Resume", "primary", steer("resume")), button("Stop", "stop", stop)],
    ready: [
      make("a", { className: "button", href: projectUrl(scene.project) }, "Project"),
      button("Make the map", "primary", process),
      button("New…", "", begin),
    ],
  };
  byId("actions").replaceChildren(...(mayCapture ? (rows[state] ?? []) : []));
}

async function stop() {
  if (confirm("Stop recording?")) await attempt(byId("message"), () => steerCapture("stop"));
}

async function process() {
  const view = await attempt(byId("message"), () => steerCapture("process"));
  if (view) location.assign(projectUrl(view.job.project));
}

async function begin() {
  const form = byId("begin-form");
  const choices = await attempt(byId("message"), readChoices);
  if (!choices) return;
  const option = (name) => make("option", { value: name }, name);
  form.rig.replaceChildren(...choices.rigs.map(option));
  form.preset.replaceChildren(...choices.presets.map(option));
  const now = new Date(Date.now() - 60_000 * new Date().getTimezoneOffset()).toISOString();
  form.project.value = `walk-${now.slice(0, 16).replace(/[:T]/g, "-")}`;
  byId("begin").showModal();
}

byId("begin-form").addEventListener("submit", async (event) => {
  if (event.submitter?.value !== "start") return;
  event.preventDefault();
  const form = event.target;
  const capture = { project: form.project.value, rig: form.rig.value, preset: form.preset.value, place: form.place.value };
  if (await attempt(byId("begin-message"), () => startCapture(capture))) byId("begin").close();
});

function note() {
  byId("note-form").reset();
  byId("note").showModal();
}

byId("note-form").addEventListener("submit", (event) => {
  if (event.submitter?.value === "mark") attempt(byId("message"), () => markHere({ text: event.target.text.value }));
});

const press = (id, yes) => byId(id).setAttribute("aria-pressed", String(yes));
const views = {
  tilt: () => (camera.tilt(), press("tilt", !camera.above)),
  follow: () => press("follow", (follow = !follow)),
  color: () => ((byHeight = !byHeight), (byId("color").textContent = byHeight ? "Height" : "Intensity")),
  plan: () => press("plan", (scene.showPlan = !scene.showPlan)),
  sun: () => press("sun", document.body.classList.toggle("sun")),
};
for (const [id, act] of Object.entries(views)) byId(id).addEventListener("click", () => (act(), redraw()));

const KEYS = {
  t: views.tilt, f: views.follow, c: views.color, g: views.plan, s: views.sun,
  "+": () => camera.zoom(1.25), "-": () => camera.zoom(0.8),
  ArrowLeft: () => byHand(() => camera.pan(60, 0)), ArrowRight: () => byHand(() => camera.pan(-60, 0)),
  ArrowUp: () => byHand(() => camera.pan(0, 60)), ArrowDown: () => byHand(() => camera.pan(0, -60)),
};
addEventListener("keydown", (event) => {
  const typing = event.target.closest("input, select, dialog");
  const act = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
  if (!act || typing || event.ctrlKey || event.metaKey) return;
  event.preventDefault();
  act();
  redraw();
});

function byHand(act) {
  press("follow", (follow = false));
  act();
}

moveByPointer(byId("overlay"), camera, {
  onMove: redraw,
  onHand: (panned) => panned && follow && press("follow", (follow = false)),
});

let battery = null;
navigator.getBattery?.().then((found) => (battery = found));
navigator.wakeLock?.request("screen").catch(() => {}); // a dark phone shows no warnings
document.addEventListener("visibilitychange", () => document.hidden || navigator.wakeLock?.request("screen").catch(() => {}));
new ResizeObserver(redraw).observe(byId("map"));
if (!cloud.works) byId("message").textContent = "This browser cannot draw points (WebGL 2); the plan and the warnings work";

async function readRights() {
  const me = await attempt(byId("message"), readMe);
  mayCapture = me?.may.includes("capture") ?? false;
  shownActions = "";
  drawWords();
}
readRights();
