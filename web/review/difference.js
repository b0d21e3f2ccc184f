// The difference of two places on the screen: pixels that only one of them has.
// No DOM, no network.

/** Codes of `difference`. */
export const NONE = 0;
export const ONLY_FIRST = 1;
export const ONLY_SECOND = 2;
export const BOTH = 3;

/**
 * Pixels within `reach` of a marked one, along rows (`step` 1) or columns (`step` = width).
 * @param {Uint8Array} mask
 * @param {{starts: number[], step: number, length: number, reach: number}} given
 */
function widened(mask, { starts, step, length, reach }) {
  const out = new Uint8Array(mask.length);
  for (const start of starts) {
    let last = -Infinity; // the last marked pixel of this line
    for (let k = 0; k < length + reach; k += 1) {
      if (k < length && mask[start + k * step]) last = k;
      const at = k - reach; // whose window ends at k
      if (at >= 0 && at < length && last >= at - reach) out[start + at * step] = 1;
    }
  }
  return out;
}

const upTo = (/** @type {number} */ n, step = 1) => Array.from({ length: n }, (_, k) => k * step);

/**
 * Pixels at most `reach` pixels, in each direction, from a marked one.
 * @param {Uint8Array} mask
 * @param {number} width
 * @param {number} reach
 */
export function near(mask, width, reach) {
  const height = mask.length / width;
  const rows = { starts: upTo(height, width), step: 1, length: width, reach };
  const columns = { starts: upTo(width), step: width, length: height, reach };
  return widened(widened(mask, rows), columns);
}

/**
 * Compares the pixels two places mark; those at most `reach` pixels apart agree.
 * @param {Uint8Array} first 1 where the first place has points
 * @param {Uint8Array} second the same of the second place
 * @param {{width: number, reach: number}} size
 * @returns {{codes: Uint8Array, agreeing: number}} a code for each pixel; fraction that agrees
 */
export function difference(first, second, { width, reach }) {
  const [nearFirst, nearSecond] = [near(first, width, reach), near(second, width, reach)];
  const codes = new Uint8Array(first.length);
  const counts = [0, 0, 0, 0];
  for (let k = 0; k < codes.length; k += 1) {
    if (!first[k] && !second[k]) continue;
    const [one, other] = [first[k] || nearFirst[k], second[k] || nearSecond[k]];
    codes[k] = one && other ? BOTH : first[k] ? ONLY_FIRST : ONLY_SECOND;
    counts[codes[k]] += 1;
  }
  const all = counts[ONLY_FIRST] + counts[ONLY_SECOND] + counts[BOTH];
  return { codes, agreeing: all ? counts[BOTH] / all : 0 };
}
