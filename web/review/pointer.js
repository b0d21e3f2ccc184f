// Pointer, touch and wheel of the pair view: pan, orbit, zoom, move and turn the second place.

import { listenToGestures } from "../shared/gestures.js";
import { HANDLE_PX, RING_PX } from "./draw.js";

/** @import {PairView} from "./view.js" */

const RING_TOLERANCE_PX = 14;

/**
 * What a pointer at a position drags: "pan", "orbit", "lay" or "turn".
 * @param {PairView} view
 * @param {boolean} shift
 */
function grabbed(view, /** @type {number[]} */ [x, y], shift) {
  if (!view.hasHandle) return view.isFree ? "orbit" : "pan";
  const [u, v] = view.on(view.pose);
  const d = Math.hypot(x - u, y - v);
  if (d < HANDLE_PX) return "lay";
  if (Math.abs(d - RING_PX) < RING_TOLERANCE_PX) return "turn";
  return view.isFree && !shift ? "orbit" : "pan";
}

/**
 * What a drag by some pixels does.
 * @type {Record<string, (view: PairView, by: number[], from: number[], to: number[]) => void>}
 */
const DRAGS = {
  pan: (view, [dx, dy]) => view.camera.pan(dx, dy),
  orbit({ camera }, [dx, dy]) {
    camera.yaw -= dx / 150;
    camera.pitch = Math.min(Math.PI / 2, Math.max(-0.2, camera.pitch + dy / 150));
  },
  lay: (view, [dx, dy]) => view.nudge(dx / view.camera.scale, -dy / view.camera.scale),
  turn(view, _, from, to) {
    const [u, v] = view.on(view.pose);
    const angle = (/** @type {number[]} */ p) => Math.atan2(v - p[1], p[0] - u);
    view.nudge(0, 0, angle(to) - angle(from));
  },
};

/**
 * Listens on the canvas of a pair view.
 * @param {HTMLCanvasElement} canvas
 * @param {PairView} view
 */
export function listenToPointer(canvas, view) {
  /** @type {string | null} */
  let drag = null;
  listenToGestures(canvas, {
    onDown(at, event, count) {
      if (!view.hasPoints) return;
      if (view.isPicking) view.pickAt(at);
      else drag = count > 1 ? "pinch" : grabbed(view, at, event.shiftKey);
    },
    onDrag(from, to) {
      if (!drag || drag === "pinch") return;
      DRAGS[drag]?.(view, [to[0] - from[0], to[1] - from[1]], from, to);
      view.draw();
    },
    onPinch(before, after) {
      if (drag !== "pinch") return;
      view.zoom(after.apart / Math.max(before.apart, 1), ...before.middle);
      view.camera.pan(after.middle[0] - before.middle[0], after.middle[1] - before.middle[1]);
      view.draw();
    },
    onUp: () => (drag = null),
    onWheel: (deltaY, at) => view.zoom(Math.exp(-deltaY / 500), ...at),
  });
}
