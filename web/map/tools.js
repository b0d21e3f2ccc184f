// The tools of the map: clicks and drags become measurements, a clip box, a section, a standpoint.

import { idHere } from "../shared/address.js";
import { pickOnMap } from "../shared/api.js";
import { classText } from "../shared/class_words.js";
import { decimal, t } from "../shared/texts.js";
import { dot, lengthOf, minus, pixelM, rayAt } from "./camera.js";
import { liftBrush, paint } from "./brush.js";
import { boxOver } from "./clip.js";
import { nearestTo, standingAt } from "./flight.js";
import { frontOf } from "./framing.js";
import { KINDS, resultOf } from "./measure.js";
import { heightsShown, page, planes } from "./page.js";
import { volumeOf, volumeProblem } from "./volumes.js";

/**
 * @import {HitPoint, RayHit, SnapPoint} from "../shared/http_types"
 * @import {Camera, Screen, View} from "./camera.js"
 * @import {MapState} from "./state.js"
 * @import {Measurement, MeasureKind} from "./measure.js"
 * @typedef {object} Stage
 * @property {() => Camera} camera
 * @property {() => Screen} screen
 * @property {() => View} seen
 * @property {(next: Partial<MapState>) => void} change
 * @property {(camera: Camera) => void} flyTo
 * @property {(name: string, parallel: boolean) => void} view
 * @property {() => void} draw
 * @property {(at: number[]) => number[] | null} under the point that is drawn under a pixel
 * @property {(found: HitPoint) => void} [note] begins one there
 * @property {(of: Measurement) => void} [profile] shows it
 */

const id = idHere();
const BEHIND_M = 2000;
const PICK_PX = 2;
const SNAP_PX = 14; // corners, edges and planes this near to the pointer attract it
const MOST_SNAP = { rad: 0.1, m: 0.25 };
const STAND_AWAY = 0.15; // a click beside the walk stands on it up to this angle away [rad]
/** @type {Record<string, string>} */
const SNAPPED = { corner: "snapped-corner", edge: "snapped-edge", plane: "snapped-plane" };
const EYES_M = 1.6;

/**
 * The point of the map under a pixel, among all of its points.
 * @param {number[]} at
 * @param {Stage} stage
 */
async function pointAt(at, { camera, screen }) {
  const view = camera();
  const { origin, direction } = rayAt(view, screen(), at, BEHIND_M);
  const pixel = pixelM(view, screen());
  const reach = page.tool === "measure" && page.snapping ? SNAP_PX : 0;
  return pickOnMap(id, {
    key: page.index?.key ?? "",
    origin_m: origin,
    direction,
    pixel_rad: view.parallel ? 0 : pixel / view.distance,
    point_m: view.parallel ? PICK_PX * pixel : 0.01,
    planes: /** @type {[number, number, number, number][]} */ (planes()),
    snap_rad: view.parallel ? 0 : Math.min((reach * pixel) / view.distance, MOST_SNAP.rad),
    snap_m: view.parallel ? Math.min(reach * pixel, MOST_SNAP.m) : 0,
  });
}

/** What is known of a point, in words. */
function pointText(/** @type {HitPoint} */ point) {
  const { p_map, p_crs, classification, t_s, sensor, position_sd_m, surface_sd_m } = point;
  const mm = (/** @type {number | null} */ m, /** @type {string} */ text) =>
    m === null ? "" : `${text} ${decimal(1000 * m, 1)} mm`;
  const [x, y, z] = p_map.map((value) => decimal(value, 3));
  const place = `x ${x}  y ${y}  z ${z} m`;
  const [e, n, h] = (p_crs ?? []).map((value) => decimal(value, 3));
  const there = p_crs ? `E ${e}  N ${n}  H ${h} (${page.index?.crs})` : "";
  const more = [
    classText(classification),
    t("intensity-of", { value: point.intensity }),
    `${decimal(t_s, 1)} s`,
    sensor,
    mm(position_sd_m, t("sd-of-pose")),
    mm(surface_sd_m, t("thickness-of")),
  ];
  return [place, there, more.filter(Boolean).join(" · ")].filter(Boolean).join("\n");
}

/**
 * A click on the map, for the tool that is chosen.
 * @param {number[]} at
 * @param {Stage} stage
 */
export function clicked(at, stage) {
  if (page.tool === "stand") return stand(at, stage);
  if (page.tool === "brush") return Promise.resolve(paint(at, at, { ...stage, done: true }));
  const answer = pointAt(at, stage);
  answer.catch(() => {}); // it is awaited in its turn
  const { tool } = page;
  const begun = begunNow();
  return inTurn(async () => {
    const found = await answer;
    if (tool === "measure") return add(found, begun, stage);
    if (tool === page.tool) take(found, stage);
  });
}

/**
 * What is being measured. Clicks belong to what they were made in: who is faster than the answers
 * ends it, and has chosen the next tool when the last point comes.
 * @typedef {{measuring: MeasureKind, draft: typeof page.draft}} Begun
 * @returns {Begun}
 */
const begunNow = () => ({ measuring: page.measuring, draft: page.draft });

/** What clicks lead to, in the order of the clicks: answers may overtake each other. */
const clicks = { last: Promise.resolve() };

function inTurn(/** @type {() => void | Promise<void>} */ next) {
  const done = clicks.last.then(next);
  clicks.last = done.catch(() => {});
  return done;
}

/** What a point that was picked is for a measurement: where it snapped to, if it did. */
function ended(/** @type {HitPoint} */ point, /** @type {SnapPoint | null} */ snap) {
  const sd = point.position_sd_m === null ? NaN : Math.hypot(point.position_sd_m, snap?.sd_m ?? 0);
  const { p_map: p, p_crs: crs } = snap ?? point;
  return { p, sd, crs, snap: snap?.kind ?? "" };
}

/**
 * @param {RayHit} hit
 * @param {Stage} stage
 */
function take({ point: found }, stage) {
  if (!found) return read(t("no-point-here"), stage);
  if (page.tool === "note") {
    choose("", stage);
    return stage.note?.(found);
  }
  if (page.tool === "like") {
    page.like = { place: found.p_map, boxes: [] };
    choose("", stage);
    return stage.change({});
  }
  read(pointText(found), stage);
}

/**
 * Adds a point to what is being measured.
 * @param {RayHit} hit
 * @param {Begun} begun
 * @param {Stage} stage
 */
function add({ point: found, snap }, begun, stage) {
  const { draft, measuring } = begun;
  const goesOn = draft === page.draft;
  if (!found) return goesOn ? read(t("no-point-here"), stage) : undefined;
  const one = ended(found, snap);
  const { least, most } = KINDS[measuring];
  const near = PICK_PX * pixelM(stage.camera(), stage.screen());
  const before = least === most ? draft.at(-1) : null; // others end by a double click
  if (before && lengthOf(minus(before.p, one.p)) < near) return; // a double click is one point
  draft.push(one);
  if (draft.length >= most) return finishMeasurement(begun, stage);
  if (!goesOn) return;
  const there = pointText({ ...found, p_map: one.p, p_crs: one.crs });
  read([one.snap && t(SNAPPED[one.snap] ?? "snapped"), there].filter(Boolean).join("\n"), stage);
}

/**
 * The point to fly to after a double click.
 * @param {number[]} at
 * @param {Stage} stage
 */
export async function target(at, stage) {
  const { point: found } = await pointAt(at, stage);
  if (!found) return;
  const camera = stage.camera();
  stage.flyTo({ ...camera, target: found.p_map, distance: Math.max(camera.distance / 2.5, 1.5) });
}

/** Ends the measurement when the answers to its clicks have come. */
export function finish(/** @type {Stage} */ stage) {
  const begun = begunNow();
  return inTurn(() => finishMeasurement(begun, stage));
}

/** Removes the last point of the measurement: a click beside what was meant. */
export function undoPoint(/** @type {Stage} */ stage) {
  const { draft, measuring } = begunNow();
  return inTurn(() => {
    if (!draft.pop() || draft !== page.draft) return;
    read(draft.length ? t("point-undone") : KINDS[measuring].hint, stage);
  });
}

/**
 * A double click ends a measurement whose corners are not counted; its second click is no corner.
 * @param {Stage} stage
 */
export function finishHere(stage) {
  const begun = begunNow();
  return inTurn(() => {
    const { draft, measuring } = begun;
    if (KINDS[measuring].least === KINDS[measuring].most) return;
    const [a, b] = draft.slice(-2);
    const near = SNAP_PX * pixelM(stage.camera(), stage.screen());
    if (a && b && lengthOf(minus(a.p, b.p)) < near) draft.pop();
    finishMeasurement(begun, stage);
  });
}

/** A measurement in words; of a volume when it is known. */
function measuredText(/** @type {Measurement} */ made) {
  const { value, parts } = resultOf(made, volumeOf(made));
  return [`${made.name}: ${volumeProblem(made) || value}`, parts].filter(Boolean).join("\n");
}

/**
 * Ends the measurement that has enough points.
 * @param {Begun} begun
 * @param {Stage} stage
 */
function finishMeasurement({ draft, measuring }, stage) {
  const { state } = page;
  if (draft.length < KINDS[measuring].least) return;
  const same = state.measurements.filter(({ kind }) => kind === measuring).length + 1;
  const made = {
    kind: measuring,
    points: draft.map(({ p }) => p),
    name: `${KINDS[measuring].text} ${same}`,
    sd: draft.map(({ sd }) => sd),
    snaps: draft.map(({ snap }) => snap),
  };
  draft.length = 0; // the next one may have been begun by clicks that wait for their answers
  if (draft === page.draft) page.reading = () => measuredText(made);
  stage.change({ measurements: [...state.measurements, made] });
  if (made.kind === "profile") stage.profile?.(made);
}

/**
 * A drag of a tool: of a brush over what is seen, of others over the image from above.
 * @param {number[]} from
 * @param {number[]} to
 * @param {Stage & {done: boolean}} stage
 */
export function dragged(from, to, stage) {
  if (page.tool === "brush") return paint(from, to, stage);
  page.drag = stage.done ? null : [from, to];
  if (!stage.done) return stage.draw();
  const [a, b] = [from, to].map((at) => onLevel(at, stage));
  const { clip } = page.state;
  if (page.tool === "box") {
    const { yaw } = stage.camera();
    const box = boxOver(a, b, { yaw: -yaw, heights: heightsShown() });
    choose("", stage);
    stage.change({ clip: { ...clip, box } });
  } else if (Math.hypot(b[0] - a[0], b[1] - a[1]) > 0.1) {
    const section = {
      a: /** @type {[number, number]} */ (a.slice(0, 2)),
      b: /** @type {[number, number]} */ (b.slice(0, 2)),
      thickness: 0.5,
    };
    choose("", stage);
    stage.change({ clip: { ...clip, section } });
    face(stage);
  }
}

/** A second finger, or the system, ended a drag. */
export function canceled(/** @type {Stage} */ stage) {
  liftBrush();
  page.drag = null;
  stage.draw();
}

/** Turns the camera straight to the section. */
export function face(/** @type {Stage} */ stage) {
  const { section } = page.state.clip;
  if (section) stage.flyTo(frontOf(section, heightsShown(), stage.seen()));
}

/**
 * Where the ray of a pixel crosses the level of the camera's target.
 * @param {number[]} at
 * @param {Stage} stage
 */
export function onLevel(at, { camera, screen }) {
  const { origin, direction } = rayAt(camera(), screen(), at);
  const [, , z] = camera().target;
  const along = Math.abs(direction[2]) < 1e-6 ? 0 : (z - origin[2]) / direction[2];
  return [0, 1, 2].map((k) => origin[k] + along * direction[k]);
}

/**
 * Stands on the walk near a click; elsewhere on what was clicked.
 * @param {number[]} at
 * @param {Stage} stage
 */
async function stand(at, stage) {
  const { walk } = page;
  const ray = rayAt(stage.camera(), stage.screen(), at, BEHIND_M);
  const { yaw } = stage.camera();
  const near = walk?.t_s.length ? nearestTo(walk, ray) : null;
  const { point: found } = await pointAt(at, stage);
  const depth = found ? dot(minus(found.p_map, ray.origin), ray.direction) : BEHIND_M;
  const onWalk = near && (stage.camera().parallel ? near.away * depth < 1 : near.away < STAND_AWAY);
  if (near && onWalk) page.flight.time = near.time;
  const eye = near && onWalk ? near.position : found && [...found.p_map];
  if (!eye) return read(t("click-walk"), stage);
  if (!onWalk) eye[2] += EYES_M;
  choose("", stage);
  stage.change({
    standing: true,
    clip: { ...page.state.clip, heights: [null, null], section: null, box: null },
    cutCeiling: false,
  });
  stage.flyTo(standingAt(eye, yaw, -0.08));
}

/**
 * Chooses a tool, or none; the same one again ends it.
 * @param {import("./page.js").Tool} tool
 * @param {Stage} stage
 * @param {MeasureKind} [kind]
 */
export function choose(tool, stage, kind = page.measuring) {
  if (tool === "note" && !page.mayProcess) return read(t("look-only"), stage);
  const same = tool === page.tool && (tool !== "measure" || kind === page.measuring);
  Object.assign(page, { tool: same ? "" : tool, measuring: kind, draft: [], drag: null });
  const hints = {
    "": "",
    measure: KINDS[kind].hint,
    box: t("drag-box"),
    section: t("drag-section"),
    stand: t("click-stand"),
    note: t("click-note"),
    brush: t("drag-brush"),
    like: t("click-thing"),
  };
  liftBrush();
  page.reading = hints[page.tool];
  const above = Math.abs(stage.camera().pitch + Math.PI / 2) < 0.02 && stage.camera().parallel;
  if ((page.tool === "box" || page.tool === "section") && !above) stage.view("top", true);
  if (page.tool === "stand" && !page.state.layers.includes("walk"))
    stage.change({ layers: [...page.state.layers, "walk"] });
  stage.draw();
}

/**
 * @param {string} text
 * @param {Stage} stage
 */
function read(text, stage) {
  page.reading = text;
  stage.draw();
}
