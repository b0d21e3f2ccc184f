// The length of a scale bar and its caption. No DOM, no network.

/** 1, 2 or 5 times a power of ten, at least `least`. */
export function roundStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * [1, 2, 5, 10].find((s) => s * power >= least * 0.999);
}

/** Scale bar of at least `leastPx`: its length in meters and in pixels, and its caption. */
export function scaleBar(pxPerM, leastPx = 60) {
  const meters = roundStep(leastPx / pxPerM);
  const text = meters < 1 ? `${Number((meters * 100).toPrecision(2))} cm` : `${meters} m`;
  return { meters, px: meters * pxPerM, text };
}
