// Texts over the map, moved apart where they would cover each other. No DOM.

/** @typedef {{x: number, y: number, words: string}} Label begin of its line of writing [px] */

const LINE_PX = 16;
const CHARACTER_PX = 7.5; // of the widest usual text

const widthOf = (/** @type {Label} */ { words }) => words.length * CHARACTER_PX;

const covers = (/** @type {Label} */ a, /** @type {Label} */ b) =>
  Math.abs(a.y - b.y) < LINE_PX && a.x < b.x + widthOf(b) && b.x < a.x + widthOf(a);

/**
 * The labels in their order; one that would cover an earlier one is below it.
 * @param {Label[]} labels
 */
export function apart(labels) {
  /** @type {Label[]} */
  const placed = [];
  for (const label of labels) {
    const free = { ...label };
    // each step is to the line below a covered one, so it ends
    for (let covered; (covered = placed.find((one) => covers(one, free)));)
      free.y = covered.y + LINE_PX;
    placed.push(free);
  }
  return placed;
}
