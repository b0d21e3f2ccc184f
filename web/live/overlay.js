// Draws over the points: coverage plan, path with the stretches of findings, gaps, marks, position.

import { drawScaleBar } from "../shared/scale_bar.js";
import { t } from "../shared/texts.js";
import { circle, label, polygon } from "./shapes.js";
import { drawStretches } from "./stretch_marks.js";

/**
 * @import {Gap, Mark, MarkedStretch, Plan, Pose} from "./messages"
 * @import {Camera} from "./camera.js"
 * @typedef {Mark & {p: number[]}} PlacedMark
 * @typedef {number[][]} Box its corners, [[x, y], [x, y]] [m]
 * @typedef {Plan & {bitmap: ImageBitmap, box: Box | null}} PaintedPlan
 * @typedef {Record<"path" | "gap" | "me" | "ink" | "sky" | "accent" | "well" | "poor" | "bad",
 *   string>} Styles
 * @typedef {{left: number, right: number, top: number, bottom: number}} Area [px]
 * @typedef {CanvasRenderingContext2D} Context
 * @typedef {object} Drawn what is drawn
 * @property {Array<[number, number, number]>} path
 * @property {PlacedMark[]} marks
 * @property {MarkedStretch[]} stretches
 * @property {Gap[]} gaps
 * @property {Pose | null} me
 * @property {PaintedPlan | null} plan
 * @property {boolean} showPlan
 * @property {number} chosen index of the chosen gap
 */

const SEEN = { FREE: 1, POOR: 2, WELL: 3 };

const PX = 4;
/** @type {Record<number, (x: number, y: number) => number>} */
const INKS = {
  [SEEN.FREE]: () => 0.12,
  [SEEN.POOR]: (x, y) => ((x + y) % PX < 2 ? 0.95 : 0.3),
  [SEEN.WELL]: () => 0.4,
};
const LONGEST_NOTE = 24;

/**
 * The plan as an image of 4 x 4 pixels per cell, x to the right and y up; cells seen poorly are
 * hatched. `box` is the bounding box of the cells seen well, [[x, y], [x, y]] in meters; null if
 * there are none.
 * @param {Plan} plan
 * @param {[string, string]} given
 */
export async function planImage(plan, [poor, well]) {
  const bytes = Uint8Array.from(atob(plan.seen), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const seen = new Uint8Array(await new Response(stream).arrayBuffer());
  const [along, across] = plan.shape;
  const image = new ImageData(PX * along, PX * across);
  const pixels = new Uint32Array(image.data.buffer);
  const stamps = new Map(
    Object.entries(INKS).map(([kind, ink]) => [
      Number(kind),
      stamp(Number(kind) === SEEN.POOR ? poor : well, ink),
    ]),
  );
  const cells = { from: [Infinity, Infinity], to: [-Infinity, -Infinity] };
  for (let i = 0; i < along; i++)
    for (let j = 0; j < across; j++) {
      const kind = seen[i * across + j];
      const pattern = stamps.get(kind);
      if (!pattern) continue;
      const first = PX * ((across - 1 - j) * PX * along + i);
      for (let y = 0; y < PX; y++)
        pixels.set(pattern.subarray(PX * y, PX * (y + 1)), first + y * PX * along);
      if (kind === SEEN.WELL) widen(cells, i, j);
    }
  return { ...plan, bitmap: await createImageBitmap(image), box: boxOf(plan, cells) };
}

/**
 * The pixels of one cell.
 * @param {string} color
 * @param {(x: number, y: number) => number} ink
 */
function stamp(color, ink) {
  const bytes = new Uint8ClampedArray(4 * PX * PX);
  for (let y = 0; y < PX; y++)
    for (let x = 0; x < PX; x++) bytes.set([...rgb(color), 255 * ink(x, y)], 4 * (PX * y + x));
  return new Uint32Array(bytes.buffer);
}

/**
 * @param {{from: number[], to: number[]}} given
 * @param {number} i
 * @param {number} j
 */
function widen({ from, to }, i, j) {
  if (i < from[0]) from[0] = i;
  if (j < from[1]) from[1] = j;
  if (i > to[0]) to[0] = i;
  if (j > to[1]) to[1] = j;
}

/**
 * @param {Plan} given
 * @param {{from: number[], to: number[]}} given1
 */
function boxOf({ first_cell: first, cell_m: size }, { from, to }) {
  if (to[0] < from[0]) return null;
  return [
    from.map((k, axis) => (k + first[axis]) * size),
    to.map((k, axis) => (k + 1 + first[axis]) * size),
  ];
}

const rgb = (/** @type {string} */ hex) =>
  [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

/**
 * Draws; `middle` is the target's position, `free` the area no bar covers: {left, top, right,
 * bottom} [px].
 * @param {Context} context
 * @param {{width: number, height: number, ratio: number, middle: [number, number],
 *   free: Area}} window
 * @param {Camera} camera
 * @param {Drawn} scene
 * @param {Styles} styles
 */
export function drawOverlay(
  context,
  { width, height, ratio, middle, free },
  camera,
  scene,
  styles,
) {
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.translate(...middle);
  const floor = scene.me?.p[2] ?? 0;
  const inside = {
    left: free.left - middle[0],
    right: free.right - middle[0],
    top: free.top - middle[1],
    bottom: free.bottom - middle[1],
  };
  if (scene.showPlan && scene.plan && camera.above) drawPlan(context, camera, scene.plan);
  drawPath(context, camera, scene.path, styles);
  drawStretches(context, camera, scene.stretches, { inside, styles });
  if (scene.showPlan)
    scene.gaps.forEach((gap, k) =>
      drawGap(context, camera, [...gap.p, floor], gap, styles, k === scene.chosen),
    );
  if (scene.path.length) drawStart(context, camera, scene.path[0], inside, styles);
  for (const mark of scene.marks) drawMark(context, camera, mark, styles);
  if (scene.me) drawMe(context, camera, scene.me, styles);
  drawScaleBar(context, camera.pxPerM, {
    left: inside.left + 14,
    bottom: inside.bottom - 12,
    ink: styles.ink,
    halo: styles.sky,
  });
}

/**
 * @param {Context} context
 * @param {Camera} camera
 * @param {PaintedPlan} plan
 */
function drawPlan(context, camera, plan) {
  const [i, j] = plan.first_cell;
  const [along, across] = plan.shape;
  const z = camera.target[2];
  const corner = camera.project([i * plan.cell_m, (j + across) * plan.cell_m, z]);
  const right = camera.project([(i + along) * plan.cell_m, (j + across) * plan.cell_m, z]);
  const below = camera.project([i * plan.cell_m, j * plan.cell_m, z]);
  const [w, h] = [plan.bitmap.width, plan.bitmap.height];
  context.save();
  context.transform(
    (right[0] - corner[0]) / w,
    (right[1] - corner[1]) / w,
    (below[0] - corner[0]) / h,
    (below[1] - corner[1]) / h,
    ...corner,
  );
  context.imageSmoothingEnabled = false;
  context.drawImage(plan.bitmap, 0, 0);
  context.restore();
}

/**
 * @param {Context} context
 * @param {Camera} camera
 * @param {number[][]} path
 * @param {Styles} styles
 */
function drawPath(context, camera, path, styles) {
  if (path.length < 2) return;
  context.beginPath();
  for (const place of path) context.lineTo(...camera.project(place));
  context.lineJoin = "round";
  /** @type {Array<[number, string]>} */
  const lines = [
    [6, styles.sky],
    [3, styles.path],
  ];
  for (const [width, color] of lines) {
    context.lineWidth = width;
    context.strokeStyle = color;
    context.stroke();
  }
}

/**
 * A ring at the start of the path; if it is out of sight, an arrow at the edge points there.
 * @param {Context} context
 * @param {Camera} camera
 * @param {number[]} place
 * @param {Area} inside
 * @param {Styles} styles
 */
function drawStart(context, camera, place, inside, styles) {
  const [x, y] = camera.project(place);
  /** @type {[number, number]} */
  const at = [
    Math.min(Math.max(x, inside.left + 40), inside.right - 40),
    Math.min(Math.max(y, inside.top + 40), inside.bottom - 50),
  ];
  if (Math.hypot(at[0] - x, at[1] - y) < 20) {
    circle(context, x, y, 6, styles.sky, styles.path);
    label(context, t("start-here"), x, y + 18, styles.path, styles.sky);
    return;
  }
  context.save();
  context.translate(...at);
  context.rotate(Math.atan2(y - at[1], x - at[0]));
  polygon(
    context,
    [
      [36, 0],
      [24, 8],
      [24, -8],
    ],
    styles.path,
    styles.sky,
  );
  context.restore();
  label(context, t("start-here"), ...at, styles.path, styles.sky);
}

/**
 * @param {Context} context
 * @param {Camera} camera
 * @param {number[]} place
 * @param {Gap} gap
 * @param {Styles} styles
 * @param {boolean} chosen
 */
function drawGap(context, camera, place, gap, styles, chosen) {
  const [x, y] = camera.project(place);
  const r = Math.max(10, (gap.width_m * camera.pxPerM) / 2);
  context.beginPath();
  context.arc(x, y, Math.min(r, 60), 0, 2 * Math.PI);
  context.setLineDash(chosen ? [] : [5, 4]);
  context.lineWidth = chosen ? 5 : 2;
  context.strokeStyle = styles.gap;
  context.stroke();
  context.setLineDash([]);
  label(context, "?", x, y, styles.gap, styles.sky);
}

/**
 * @param {Context} context
 * @param {Camera} camera
 * @param {PlacedMark} mark
 * @param {Styles} styles
 */
function drawMark(context, camera, mark, styles) {
  const [x, y] = camera.project(mark.p);
  circle(context, x, y, 6, styles.accent, styles.sky);
  const text =
    mark.text.length > LONGEST_NOTE ? `${mark.text.slice(0, LONGEST_NOTE - 1)}…` : mark.text;
  if (text) label(context, text, x + 11, y, styles.ink, styles.sky, "left");
}

/**
 * @param {Context} context
 * @param {Camera} camera
 * @param {Pose} me
 * @param {Styles} styles
 */
function drawMe(context, camera, me, styles) {
  const [x, y] = camera.project(me.p);
  const [fx, fy] = camera.project([
    me.p[0] + Math.cos(me.yaw),
    me.p[1] + Math.sin(me.yaw),
    me.p[2],
  ]);
  context.save();
  context.translate(x, y);
  context.rotate(Math.atan2(fy - y, fx - x));
  polygon(
    context,
    [
      [18, 0],
      [-11, 11],
      [-5, 0],
      [-11, -11],
    ],
    me.lost ? styles.gap : styles.me,
    styles.sky,
  );
  context.restore();
}
