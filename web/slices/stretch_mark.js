// The marked stretch of the walk, as that of a finding. No DOM, no network.

/** The mark of a stretch of the walk, "x,y,z,x,y,z", in a horizontal slice; elsewhere no points. */
export function stretchMark(
  /** @type {Pick<import("./state.js").SliceState, "kind" | "mark">} */ { kind, mark },
) {
  const numbers = mark.split(",").map(Number);
  if (kind !== "horizontal" || numbers.length !== 6 || !numbers.every(Number.isFinite))
    return { points: [] };
  return { points: [numbers.slice(0, 2), numbers.slice(3, 5)], tone: "--bad" };
}
