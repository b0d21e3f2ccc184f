// Pins and marked stretches: flying to them, by a click, the panel or a link.

import { heightsOf, page, pinsShown } from "./page.js";
import { cameraAt, clipAround, lineOf, pinAt } from "./places.js";
import { parse } from "./state.js";

/**
 * @import {Mark, Pin} from "./places.js"
 * @import {Stage} from "./tools.js"
 */

/**
 * What marks places.
 * @param {Stage} stage
 */
export function markingOf({ camera, screen, seen, change, flyTo }) {
  /** Marks a stretch or a place, and flies there; what hides it is not clipped any more. */
  function mark(/** @type {Mark} */ one) {
    const { index, state, walk } = page;
    const line = lineOf(one, walk);
    if (!line.length || !index) return change({ mark: one });
    const clip = clipAround(state.clip, line[line.length >> 1], { index, heightsOf });
    const cutCeiling = state.cutCeiling && clip.heights === state.clip.heights;
    change({ mark: one, clip, cutCeiling, standing: false });
    flyTo(cameraAt(line, camera(), seen()));
  }

  return {
    mark,
    /** Shows what a pin is of, where it is. */
    choosePin(/** @type {Pin} */ pin) {
      page.chosen = pin;
      page.reading = pin.text;
      mark(pin.mark);
    },
    pinUnder: (/** @type {number[]} */ at) =>
      pinAt(pinsShown(), at, { camera: camera(), screen: screen() }),
    /** A finding in the bar above leads to its place on this page, without loading it again. */
    followLinks(/** @type {MouseEvent} */ event) {
      const link = /** @type {Element} */ (event.target).closest("a.stretch");
      if (!(link instanceof HTMLAnchorElement) || link.pathname !== location.pathname) return;
      const { mark: one } = parse(link.search);
      if (!one || event.ctrlKey || event.metaKey || event.shiftKey) return;
      event.preventDefault();
      mark(one);
    },
  };
}
