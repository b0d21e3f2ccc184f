// Details and points of pairs, read ahead and kept for a few pairs. No DOM.

import { readPair, readPoints } from "../shared/api.js";
import { keyOf } from "./captions.js";

const MOST = 8; // pairs that are kept

export class PairLoader {
  #id;
  #loaded = new Map();

  constructor(id) {
    this.#id = id;
  }

  /** Promise of [details, points] of a pair, with points of `reach` multiframes on each side. */
  load(pair, reach) {
    const key = `${keyOf(pair)} ${reach}`;
    if (!this.#loaded.has(key)) {
      const both = Promise.all([readPair(this.#id, pair), readPoints(this.#id, pair, reach)]);
      both.catch(() => this.#loaded.delete(key));
      this.#loaded.set(key, both);
      if (this.#loaded.size > MOST) this.#loaded.delete(this.#loaded.keys().next().value);
    }
    return this.#loaded.get(key);
  }

  clear() {
    this.#loaded.clear();
  }
}
