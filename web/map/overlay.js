// What lies over the map as lines and texts: measurements, clip box, section, findings.

import { nothing, svg } from "../shared/dom.js";
import { add, axesOf, eyeOf, focalPx, minus, dot, toScreen } from "./camera.js";
import { cornersOfBox } from "./clip.js";
import { apart } from "./labels.js";
import { resultOf } from "./measure.js";

/**
 * @import {Box} from "../shared/alike.js"
 * @import {Camera, Screen} from "./camera.js"
 * @import {Clip} from "./clip.js"
 * @import {Measurement} from "./measure.js"
 * @import {Content} from "../shared/dom.js"
 * @import {Pin} from "./places.js"
 */

const EDGES = [0, 1, 2].flatMap((axis) =>
  [0, 1, 2, 3, 4, 5, 6, 7].filter((k) => !((k >> axis) & 1)).map((k) => [k, k | (1 << axis)]),
);
const NEAR_M = 0.06;
const MOST_BOXES = 80; // further things are dots
const MOST_SHOWN = 60; // characters of a text beside a pin

/**
 * @param {{camera: Camera, screen: Screen}} view
 * @param {{measurements: Measurement[], draft: number[][], clip: Clip, heights: [number, number],
 *   pins: Pin[], chosen: Pin | null, stretch: number[][], drag: number[][] | null,
 *   brush: {strokes: number[][][], radius: number},
 *   boxes: Box[], times: string, aim: boolean, tool: string,
 *   volumeOf: (one: Measurement) => any}} shown
 * @returns {Content}
 */
export function overlay({ camera, screen }, shown) {
  const at = (/** @type {number[]} */ p) => toScreen(camera, screen, p);
  /** A line in space, as far as it is ahead of the eye. */
  const line = (
    /** @type {number[]} */ a,
    /** @type {number[]} */ b,
    /** @type {string} */ kind,
  ) => {
    const ends = camera.parallel ? [a, b] : ahead(camera, a, b);
    const [from, to] = (ends ?? []).map(at);
    return from && to
      ? svg`<line class=${kind} x1=${from.x} y1=${from.y} x2=${to.x} y2=${to.y} />`
      : nothing;
  };
  const dot = (/** @type {number[]} */ p, /** @type {string} */ kind) => {
    const to = at(p);
    return to ? svg`<circle class=${kind} cx=${to.x} cy=${to.y} r="4" />` : nothing;
  };
  /** What the brush covers around a place. */
  const dab = (/** @type {number[]} */ p) => {
    const to = at(p);
    const away = camera.parallel ? camera.distance : (to?.depth ?? 1);
    const r = (shown.brush.radius * focalPx(screen)) / away;
    return to ? svg`<circle class="brush" cx=${to.x} cy=${to.y} r=${r} />` : nothing;
  };
  const text = (/** @type {number[]} */ p, /** @type {string} */ words) => {
    const to = at(p);
    return to ? svg`<text x=${to.x + 9} y=${to.y - 7}>${words}</text>` : nothing;
  };
  const path = (/** @type {number[][]} */ points, /** @type {boolean} */ closed) =>
    points.map((p, k) => {
      const next = points[k + 1] ?? (closed && points.length > 2 ? points[0] : null);
      return next ? line(p, next, "measure") : nothing;
    });
  /** A needle with a head; its text if it is chosen. */
  const pin = (/** @type {Pin} */ { kind, name, p, level, text: words }) => {
    const to = at(p);
    if (!to) return nothing;
    const here = shown.chosen?.kind === kind && shown.chosen.name === name;
    return svg`<g class="pin ${kind} ${level} ${here ? "chosen" : ""}"
      transform="translate(${to.x} ${to.y})">
      <path d="M0 0 L-6 -12 A7 7 0 1 1 6 -12 Z" />
      ${here ? svg`<text x="12" y="-12">${headOf(words)}</text>` : nothing}</g>`;
  };
  const { measurements, draft, clip, pins, stretch, drag, tool } = shown;
  const section = clip.section ? sectionLines(clip.section, shown.heights) : [];
  const corners = clip.box ? cornersOfBox(clip.box) : [];
  return svg`<g class="brushed">${shown.brush.strokes.flat().map(dab)}</g>
    ${shown.boxes.slice(0, MOST_BOXES).map((box) => {
      const ends = cornersBetween(box);
      return EDGES.map(([a, b]) => line(ends[a], ends[b], "alike"));
    })}
    ${shown.boxes.slice(MOST_BOXES).map(({ low, high }) => dot(middleOf([low, high]), "alike"))}
    ${clip.box ? EDGES.map(([a, b]) => line(corners[a], corners[b], "clip")) : nothing}
    ${section.map(([a, b]) => line(a, b, "clip"))}
    ${measurements.map((one) => [
      path(one.points, one.kind === "area" || one.kind === "volume"),
      one.points.map((p) => dot(p, "measure")),
    ])}
    ${apart(
      measurements.flatMap((one) => {
        const to = at(middleOf(one.points));
        const words = `${one.name}: ${resultOf(one, shown.volumeOf(one)).value}`;
        return to ? [{ x: to.x + 9, y: to.y - 7, words }] : [];
      }),
    ).map(({ x, y, words }) => svg`<text x=${x} y=${y}>${words}</text>`)}
    ${path(draft, false)}${draft.map((p) => dot(p, "draft"))}
    ${stretch.slice(1).map((p, k) => line(stretch[k], p, "stretch"))}
    ${[...stretch.slice(0, 1), ...stretch.slice(-1)].map((p) => dot(p, "stretch"))}
    ${stretch.length ? text(stretch[stretch.length >> 1], shown.times) : nothing}
    ${pins.map(pin)}
    ${drag ? dragged(drag, tool) : nothing}${shown.aim ? cross(screen) : nothing}`;
}

/** @param {Box} box */
const cornersBetween = ({ low, high }) =>
  [0, 1, 2, 3, 4, 5, 6, 7].map((which) =>
    [0, 1, 2].map((k) => ((which >> k) & 1 ? high[k] : low[k])),
  );

/** The begin of a text, as long as one reads it beside a pin. */
const headOf = (/** @type {string} */ text) =>
  text.length > MOST_SHOWN ? `${text.slice(0, MOST_SHOWN)}…` : text;

/** What is picked by keyboard. */
const cross = (/** @type {Screen} */ { width, height }) =>
  svg`<path class="cross" transform="translate(${width / 2} ${height / 2})"
    d="M-14 0h28M0 -14v28" />`;

const middleOf = (/** @type {number[][]} */ points) =>
  points.reduce((sum, p) => add(sum, p), [0, 0, 0]).map((x) => x / points.length);

/**
 * @param {number[][]} drag
 * @param {string} tool
 */
function dragged([[ax, ay], [bx, by]], tool) {
  if (tool === "section") return svg`<line class="clip" x1=${ax} y1=${ay} x2=${bx} y2=${by} />`;
  return svg`<rect class="clip" x=${Math.min(ax, bx)} y=${Math.min(ay, by)}
    width=${Math.abs(bx - ax)} height=${Math.abs(by - ay)} />`;
}

/**
 * @param {NonNullable<Clip["section"]>} section
 * @param {[number, number]} heights
 */
const sectionLines = ({ a, b }, [low]) => [
  [
    [...a, low],
    [...b, low],
  ],
];

/**
 * A line without what is behind the eye; null if all of it is.
 * @param {Camera} camera
 * @param {number[]} a
 * @param {number[]} b
 */
function ahead(camera, a, b) {
  const [eye, axis] = [eyeOf(camera), axesOf(camera).ahead];
  const [from, to] = [a, b].map((p) => dot(minus(p, eye), axis) - NEAR_M);
  if (from < 0 && to < 0) return null;
  if (from >= 0 && to >= 0) return [a, b];
  const cut = add(a, minus(b, a), from / (from - to));
  return from < 0 ? [cut, b] : [a, cut];
}
