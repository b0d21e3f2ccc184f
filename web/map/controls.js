// Pointer, touch and wheel on the map: they move the camera, or are given to a tool.

import { listenToGestures } from "../shared/gestures.js";
import { add, axesOf, lookedAround, orbited, panned, zoomed } from "./camera.js";

/**
 * @import {Camera, Screen} from "./camera.js"
 * @typedef {object} Controls
 * @property {() => Camera} camera
 * @property {() => Screen} screen
 * @property {() => boolean} standing whether a drag looks around
 * @property {() => boolean} dragging whether a tool takes drags
 * @property {(camera: Camera) => void} move
 * @property {(at: number[]) => number[] | null} under the point of the map under a pixel
 * @property {(at: number[]) => void} click
 * @property {() => void} finish what the clicks of a tool began: a click with the right button
 * @property {(from: number[], to: number[], done: boolean) => void} drag of a tool
 * @property {() => void} cancel the drag of the tool: a second finger, or the system, ended it
 */

const CLICK_PX = 5;
const TAP_PX = 12; // a finger rolls as it lifts
const SAME_PLACE_MS = 350; // turns of the wheel within this time zoom to one point

/**
 * @param {HTMLElement} element
 * @param {Controls} on
 */
export function moveByGestures(element, on) {
  const press = {
    from: [0, 0],
    far: false,
    tool: false, // whether a tool has been given this drag
    pinched: false,
    /** @type {number[] | null} */
    grabbed: null,
  };
  const cancel = () => {
    if (press.tool) on.cancel();
    press.tool = false;
  };
  const wheel = { until: 0, at: /** @type {number[] | null} */ (null) };

  /**
   * Nearer or farther, to what is under the pointer.
   * @param {number} times
   * @param {number[]} at
   */
  function zoom(times, at) {
    if (on.standing()) {
      const camera = on.camera();
      const step = -Math.log(times) * 1.5;
      on.move({ ...camera, target: add(camera.target, axesOf(camera).ahead, step) });
      return;
    }
    const now = performance.now();
    if (now > wheel.until) wheel.at = on.under(at);
    wheel.until = now + SAME_PLACE_MS;
    on.move(zoomed(on.camera(), times, wheel.at ?? undefined));
  }

  listenToGestures(element, {
    onDown(at, _, count) {
      if (count > 1) {
        Object.assign(press, { far: true, pinched: true });
        return cancel();
      }
      Object.assign(press, { from: at, far: false, tool: false, pinched: false, grabbed: null });
      element.focus({ preventScroll: true });
    },
    onDrag(from, to, event) {
      const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
      const all = Math.hypot(to[0] - press.from[0], to[1] - press.from[1]);
      if (!press.far && all < (event.pointerType === "touch" ? TAP_PX : CLICK_PX)) return;
      if (!press.far) press.grabbed = on.under(press.from);
      press.far = true;
      const sideways = event.shiftKey || event.ctrlKey || (event.buttons & 6) !== 0;
      if (on.dragging() && press.pinched) return; // the finger that is left of two
      if (on.dragging() && !sideways) {
        press.tool = true;
        on.drag(press.from, to, false);
      } else if (sideways)
        on.move(panned(on.camera(), on.screen(), [dx, dy], press.grabbed ?? undefined));
      else if (on.standing()) on.move(lookedAround(on.camera(), dx, dy));
      else on.move(orbited(on.camera(), dx, dy));
    },
    onPinch(before, after) {
      const [x, y] = [0, 1].map((k) => after.middle[k] - before.middle[k]);
      on.move(panned(on.camera(), on.screen(), [x, y]));
      zoom(before.apart / Math.max(after.apart, 1), after.middle);
    },
    onUp(at, event, count) {
      if (event.type === "pointercancel") return cancel();
      if (count > 1) return;
      if (on.dragging() && press.tool) on.drag(press.from, at, true);
      else if (!press.far && event.button === 0) on.click(at);
      else if (!press.far && event.button === 2) on.finish();
    },
    onWheel: (deltaY, at) => zoom(Math.exp(Math.max(-1, Math.min(1, deltaY * 0.0015))), at),
  });
  element.addEventListener("contextmenu", (event) => event.preventDefault());
}
