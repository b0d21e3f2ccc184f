// Shapes that are drawn over the points, each with an edge that sets it off.

/** @typedef {CanvasRenderingContext2D} Context */

/**
 * @param {Context} context
 * @param {number} x
 * @param {number} y
 * @param {number} r
 * @param {string} inside
 * @param {string} around
 */
export function circle(context, x, y, r, inside, around) {
  context.beginPath();
  context.arc(x, y, r, 0, 2 * Math.PI);
  context.lineWidth = 3;
  [context.fillStyle, context.strokeStyle] = [inside, around];
  context.fill();
  context.stroke();
}

/**
 * @param {Context} context
 * @param {Array<[number, number]>} corners
 * @param {string} inside
 * @param {string} around
 */
export function polygon(context, corners, inside, around) {
  context.beginPath();
  for (const corner of corners) context.lineTo(...corner);
  context.closePath();
  context.lineWidth = 2;
  [context.fillStyle, context.strokeStyle] = [inside, around];
  context.fill();
  context.stroke();
}

/**
 * @param {Context} context
 * @param {string} text
 * @param {number} x
 * @param {number} y
 * @param {string} color
 * @param {string} around
 */
export function label(
  context,
  text,
  x,
  y,
  color,
  around,
  align = /** @type {CanvasTextAlign} */ ("center"),
) {
  context.font = "600 14px system-ui, sans-serif";
  context.textAlign = align;
  context.textBaseline = "middle";
  context.lineWidth = 4;
  context.lineJoin = "round";
  context.strokeStyle = around;
  context.strokeText(text, x, y);
  context.fillStyle = color;
  context.fillText(text, x, y);
}
