// What a key of the map turns on and off.

import { colorShown, colorsOf, page } from "./page.js";

/** @import {MapState} from "./state.js" */

/**
 * The next color, the ceilings, the walk.
 * @param {(next: Partial<MapState>) => void} change
 */
export const togglesOf = (change) => ({
  color() {
    if (!page.index) return;
    const able = colorsOf(page.index);
    const next = able[(able.indexOf(colorShown()) + 1) % able.length];
    change({ color: next, lo: null, hi: null });
  },
  ceilings() {
    const { clip, cutCeiling } = page.state;
    if (!cutCeiling) return change({ cutCeiling: true });
    change({ cutCeiling: false, clip: { ...clip, heights: [null, null] } });
  },
  walk() {
    const { layers } = page.state;
    const without = layers.filter((one) => one !== "walk");
    change({ layers: without.length < layers.length ? without : [...layers, "walk"] });
  },
});
