// Details and points of pairs, read ahead and kept for a few pairs. No DOM.

import { readPair, readPoints } from "../shared/api.js";
import { keyOf } from "./captions.js";

/**
 * @import {PairFacts} from "../shared/http_types"
 * @import {PairPoints} from "./draw.js"
 * @typedef {[PairFacts, PairPoints]} Loaded
 */

const MOST = 8; // pairs that are kept

export class PairLoader {
  #id;
  /** @type {Map<string, Promise<Loaded>>} */
  #loaded = new Map();

  constructor(/** @type {string} */ id) {
    this.#id = id;
  }

  /**
   * Promise of [details, points] of a pair, with points of `reach` multiframes on each side.
   * @param {[number, number]} pair
   * @param {number} reach
   */
  load(pair, reach) {
    const key = `${keyOf(pair)} ${reach}`;
    const known = this.#loaded.get(key);
    if (known) return known;
    const both = Promise.all([readPair(this.#id, pair), readPoints(this.#id, pair, reach)]);
    both.catch(() => this.#loaded.delete(key));
    this.#loaded.set(key, both);
    const [oldest] = this.#loaded.keys();
    if (this.#loaded.size > MOST && oldest) this.#loaded.delete(oldest);
    return both;
  }

  clear() {
    this.#loaded.clear();
  }
}
