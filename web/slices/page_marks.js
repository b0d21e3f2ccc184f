// All that is drawn over the slices of the page. No DOM, no network.

import { brushMarks } from "./brush.js";
import { lengthText } from "./captions.js";
import { ellipseMarks } from "./ellipses.js";
import { boxMarks } from "./liking.js";
import { stretchMarks } from "./stretch_mark.js";

/**
 * @import {SlicePageState} from "./drawing.js"
 * @import {Mark} from "./marks.js"
 */

/**
 * The marks of the page: the stretch, measured points, the polygon, the brush, things that are
 * alike, error ellipses.
 * @param {SlicePageState} page
 * @returns {Mark[]}
 */
export function pageMarks(page) {
  const { measured, measuring, picked, shown, stretch, state, outline } = page;
  const [from, to] = measured;
  const text = from && to ? lengthText(from, to) : "";
  const points = measuring || measured.length ? measured : picked ? [picked] : [];
  const { corners } = outline;
  return [
    ...(shown ? stretchMarks(stretch, shown) : []),
    ...ellipseMarks(state, page.known),
    { points: points.map((one) => one.uv), text },
    ...(corners.length ? [{ points: [...corners, corners[0]], dots: corners }] : []),
    ...brushMarks(page.brush),
    ...boxMarks(state, page.like.boxes),
  ];
}
