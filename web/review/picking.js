// Picking the same three points in two places, in the first and second place by turns. No DOM.

import { t } from "../shared/texts.js";
import { IDENTITY, apply } from "./math.js";

/**
 * @import {PairPoints} from "./draw.js"
 * @typedef {[number, number, number]} Xyz
 */

const PICK_PX = 14;
const PAIRS = 3;

export class Picking {
  /** @type {Xyz[]} */
  i = []; // in the frame of the first place
  /** @type {Xyz[]} */
  j = []; // in the frame of the second place
  #names;

  constructor(names = [t("first-place"), t("second-place")]) {
    this.#names = names;
  }

  get #isFirst() {
    return this.i.length === this.j.length;
  }

  get isDone() {
    return this.j.length === PAIRS;
  }

  /** What to pick next. */
  get text() {
    const name = this.#names[this.#isFirst ? 0 : 1];
    return t("pick-point", { n: this.j.length + 1, count: PAIRS, place: name ?? "" });
  }

  /**
   * Picks the point nearest to a position on the screen, if one is near. `toScreen` gives its
   * position there, null if it is not shown.
   * @param {number[]} given
   * @param {PairPoints} points
   * @param {number[]} pose
   * @param {(p: number[]) => number[] | null} toScreen
   */
  pick([x, y], points, pose, toScreen) {
    const first = this.#isFirst;
    const [candidates, T] = first ? [points.i, IDENTITY] : [points.j, pose];
    /** @type {Xyz | null} */
    let best = null;
    let nearest = PICK_PX;
    for (let k = 0; k < candidates.length; k += 3) {
      const p = /** @type {Xyz} */ ([candidates[k], candidates[k + 1], candidates[k + 2]]);
      const at = toScreen(apply(T, p));
      const d = at ? Math.hypot(at[0] - x, at[1] - y) : Infinity;
      if (d < nearest) [nearest, best] = [d, p];
    }
    if (best) (first ? this.i : this.j).push(best);
  }
}
