// The scale bar of maps and views: its round length, its caption, its drawing.

const HEIGHT_PX = 5;

/** 1, 2 or 5 times a power of ten, at least `least`. */
export function roundStep(/** @type {number} */ least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5].find((s) => s * power >= least * 0.999) ?? 10);
}

/** Scale bar of at least `leastPx`: its length in meters and in pixels, and its caption. */
export function scaleBar(/** @type {number} */ pxPerM, leastPx = 60) {
  const meters = roundStep(leastPx / pxPerM);
  const text = meters < 1 ? `${Number((meters * 100).toPrecision(2))} cm` : `${meters} m`;
  return { meters, px: meters * pxPerM, text };
}

/**
 * Draws the bar with its caption above it. `left` or `right` is its end and `bottom` its line [px];
 * `halo` is the color around `ink`, so that both are legible on points.
 * @param {CanvasRenderingContext2D} context
 * @param {number} pxPerM
 * @param {{left?: number, right?: number, bottom: number, ink: string, halo: string}} place
 */
export function drawScaleBar(context, pxPerM, { left, right, bottom, ink, halo }) {
  const { px, text } = scaleBar(pxPerM);
  const x = left ?? (right ?? 0) - px;
  context.save();
  context.lineJoin = "round";
  context.beginPath();
  context.moveTo(x, bottom - HEIGHT_PX);
  context.lineTo(x, bottom);
  context.lineTo(x + px, bottom);
  context.lineTo(x + px, bottom - HEIGHT_PX);
  [context.lineWidth, context.strokeStyle] = [5, halo];
  context.stroke();
  [context.lineWidth, context.strokeStyle] = [2, ink];
  context.stroke();
  context.font = "600 13px system-ui, sans-serif";
  context.textAlign = "left";
  context.textBaseline = "alphabetic";
  context.lineWidth = 4;
  context.strokeStyle = halo;
  context.strokeText(text, x + 4, bottom - 7);
  context.fillStyle = ink;
  context.fillText(text, x + 4, bottom - 7);
  context.restore();
}
