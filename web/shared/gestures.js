// Pointer, touch and wheel gestures on a map or view. Positions are [x, y] in px of the element.

/**
 * @typedef {number[]} Position
 * @typedef {{middle: Position, apart: number, angle: number}} Pair two pointers
 * @typedef {object} Gestures
 * @property {(at: Position, event: PointerEvent, count: number) => void} [onDown] the count-th
 * @property {(from: Position, to: Position, event: PointerEvent) => void} [onDrag] one pointer
 * @property {(before: Pair, after: Pair) => void} [onPinch] two pointers
 * @property {(at: Position, event: PointerEvent, count: number) => void} [onUp] one of `count`
 * @property {(at: Position, event: PointerEvent) => void} [onHover] a pointer moves, pressed or not
 * @property {(deltaY: number, at: Position) => void} [onWheel]
 */

/** @returns {Pair} */
function pairOf(/** @type {Position[]} */ [a, b]) {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  return {
    middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2],
    apart: Math.hypot(dx, dy),
    angle: Math.atan2(dy, dx),
  };
}

/**
 * Listens to gestures on an element: one pointer drags, two pinch, the wheel turns.
 * @param {HTMLElement} element
 * @param {Gestures} gestures
 */
export function listenToGestures(element, { onDown, onDrag, onPinch, onUp, onHover, onWheel }) {
  /** @type {Map<number, Position>} */
  const pointers = new Map();
  const placeOf = (/** @type {MouseEvent} */ event) => {
    const box = element.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };

  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId);
    const at = placeOf(event);
    pointers.set(event.pointerId, at);
    onDown?.(at, event, pointers.size);
  });
  element.addEventListener("pointermove", (event) => {
    const to = placeOf(event);
    onHover?.(to, event);
    const from = pointers.get(event.pointerId);
    if (!from) return;
    const before = [...pointers.values()];
    pointers.set(event.pointerId, to);
    if (pointers.size === 1) onDrag?.(from, to, event);
    else if (pointers.size === 2) onPinch?.(pairOf(before), pairOf([...pointers.values()]));
  });
  const up = (/** @type {PointerEvent} */ event) => {
    if (!pointers.has(event.pointerId)) return;
    onUp?.(placeOf(event), event, pointers.size);
    pointers.delete(event.pointerId);
  };
  element.addEventListener("pointerup", up);
  element.addEventListener("pointercancel", up);
  if (!onWheel) return;
  element.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      onWheel(event.deltaY, placeOf(event));
    },
    { passive: false },
  );
}
