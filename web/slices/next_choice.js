// The next one of several choices, for keys.

import { COLORS, SURFACES } from "./state.js";

/**
 * @import {SliceFacts} from "../shared/http_types"
 * @import {Color, SliceState, Surface} from "./state.js"
 */

/**
 * The choice after the present one.
 * @template T
 * @param {T[]} choices
 * @param {T} now
 */
const nextOf = (choices, now) => choices[(choices.indexOf(now) + 1) % choices.length] ?? now;

export const nextSurface = (/** @type {SliceState} */ { surface }) =>
  nextOf(/** @type {Surface[]} */ (Object.keys(SURFACES)), surface);

/**
 * @param {SliceState} state
 * @param {SliceFacts | null} facts
 */
export function nextColor({ color, ref }, facts) {
  const able = /** @type {Color[]} */ (Object.keys(COLORS)).filter(
    (one) =>
      (one !== "distance" || ref) &&
      (one !== "normalized" || facts?.fields.includes("intensity_normalized")),
  );
  return nextOf(able, color);
}
