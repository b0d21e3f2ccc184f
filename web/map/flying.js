// Flying along the walk, and standing at one of its times.

import { positionAt, standingAt, walking } from "./flight.js";
import { page } from "./page.js";

/** @import {Stage} from "./tools.js" */

/**
 * What flies along the walk.
 * @param {Stage & {stop: () => void}} stage `stop` ends a turn of the camera
 */
export function flightOf({ camera, change, draw, stop }) {
  let before = 0;

  function onward() {
    const { flight, walk, state } = page;
    const last = walk?.t_s.at(-1) ?? 0;
    if (!flight.on || !walk || flight.time >= last) {
      flight.on = false;
      return draw();
    }
    const now = performance.now();
    flight.time = Math.min(last, flight.time + ((now - before) / 1000) * flight.speed);
    before = now;
    change({ camera: walking(walk, flight.time, state.camera ?? camera()), standing: true });
    requestAnimationFrame(onward);
  }

  /** Stands on the walk at a time. */
  function seek(/** @type {number} */ time) {
    const { walk, state } = page;
    if (!walk) return;
    page.flight.time = time;
    const { target: to } = walking(walk, time, camera());
    const here = positionAt(walk, time);
    const yaw = Math.atan2(to[0] - here[0], to[1] - here[1]);
    const clip = { ...state.clip, heights: /** @type {[null, null]} */ ([null, null]) };
    change({ camera: standingAt(here, yaw, -0.08), standing: true, clip, cutCeiling: false });
  }

  /** Begins, or ends. */
  function fly() {
    const { flight, walk } = page;
    if (!walk?.t_s.length) return;
    stop();
    flight.on = !flight.on;
    before = performance.now();
    if (flight.time >= (walk.t_s.at(-1) ?? 0)) flight.time = 0;
    seek(flight.time);
    onward();
  }

  return { fly, seek };
}
