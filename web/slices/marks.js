// Lines, dots and captions over a slice.

/**
 * @typedef {{points: number[][], dots?: number[][], text?: string, tone?: string,
 *   radius?: number}} Mark a line on the plane, its dots (else each point), its caption and its
 *   color; with a radius [m] what a brush of it covers
 * @typedef {CanvasRenderingContext2D} Pen
 * @typedef {(name: string) => string} ColorOf
 */

/**
 * @param {Pen} pen
 * @param {Mark} mark
 * @param {{toPx: (uv: number[]) => [number, number], scale: number, color: ColorOf,
 *   width: number}} view pixels per meter, and of the view
 */
export function drawMark(pen, { points, dots = points, text, tone, radius }, view) {
  if (!points.length) return;
  const { toPx, scale, color, width: wide } = view;
  const places = points.map(toPx);
  if (radius) return brushed(pen, places, { width: 2 * radius * scale, color });
  /** @type {Array<[string, number]>} */
  const strokes = [
    [color("--paper"), 5],
    [color(tone ?? "--mark"), 2],
  ];
  for (const [stroke, width] of strokes) {
    pen.strokeStyle = stroke;
    pen.lineWidth = width;
    pen.beginPath();
    places.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
    for (const [x, y] of dots.map(toPx)) {
      pen.moveTo(x + 6, y);
      pen.arc(x, y, 6, 0, 2 * Math.PI);
    }
    pen.stroke();
  }
  if (text) caption(pen, text, { at: places.at(-1) ?? [0, 0], color, wide });
}

/**
 * @param {Pen} pen
 * @param {number[][]} places
 * @param {{width: number, color: ColorOf}} how
 */
function brushed(pen, places, { width, color }) {
  pen.save();
  Object.assign(pen, { lineCap: "round", lineJoin: "round", lineWidth: width, globalAlpha: 0.35 });
  pen.strokeStyle = color("--mark");
  pen.beginPath();
  places.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  if (places.length === 1) pen.lineTo(places[0][0], places[0][1]);
  pen.stroke();
  pen.restore();
}

/**
 * @param {Pen} pen
 * @param {string} text
 * @param {{at: number[], color: ColorOf, wide: number}} how
 */
function caption(pen, text, { at: [x, y], color, wide }) {
  pen.font = "600 13px system-ui, sans-serif";
  pen.textAlign = "left";
  const width = pen.measureText(text).width;
  const left = Math.min(x + 12, wide - width - 12);
  pen.fillStyle = color("--paper");
  pen.fillRect(left - 4, y - 30, width + 8, 22);
  pen.fillStyle = color("--ink");
  pen.fillText(text, left, y - 19);
}
