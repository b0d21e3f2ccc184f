// The stretches of the walk that findings are about, over the path.

import { t } from "../shared/texts.js";
import { circle, label } from "./shapes.js";

/**
 * @import {Camera} from "./camera.js"
 * @import {MarkedStretch} from "./messages"
 * @import {Area, Styles} from "./overlay.js"
 * @import {Context} from "./shapes.js"
 */

/**
 * Color, dashes and message of the caption of each kind: no meaning rests on the color alone.
 * @type {Record<MarkedStretch["kind"], {color: "bad" | "poor", dash: number[], text: string}>}
 */
const LOOKS = {
  "TRACKING-LOST": { color: "bad", dash: [3, 9], text: "stretch-lost" },
  "WEAK-DIRECTION": { color: "poor", dash: [], text: "stretch-weak" },
};
const WIDTH_PX = 8;
const CAPTION_PX = 70; // half the width of the longest caption
const LABELED_PX = 40; // a shorter one has no caption: those of many short ones would hide the map

/**
 * @param {Context} context
 * @param {Camera} camera
 * @param {MarkedStretch[]} stretches
 * @param {{inside: Area, styles: Styles}} look captions stay inside of the area
 */
export function drawStretches(context, camera, stretches, { inside, styles }) {
  context.lineCap = "round";
  for (const { kind, p } of stretches) {
    const { color, dash, text } = LOOKS[kind];
    const places = p.map((place) => camera.project(place));
    const [first, last] = [places[0], places.at(-1)];
    if (!first || !last) continue;
    if (places.length === 1) circle(context, ...first, WIDTH_PX / 2, styles[color], styles.sky);
    context.beginPath();
    for (const place of places) context.lineTo(...place);
    context.setLineDash(dash);
    context.lineWidth = WIDTH_PX;
    context.strokeStyle = styles[color];
    context.stroke();
    context.setLineDash([]);
    const long = Math.hypot(last[0] - first[0], last[1] - first[1]) > LABELED_PX;
    if (!long && stretches.length > 1) continue;
    const [x, y] = places[places.length >> 1] ?? first;
    const middle = Math.min(Math.max(x, inside.left + CAPTION_PX), inside.right - CAPTION_PX);
    label(context, t(text), middle, y - 16, styles[color], styles.sky);
  }
  context.lineCap = "butt";
}
