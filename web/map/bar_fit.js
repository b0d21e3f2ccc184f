// Which buttons of a row of tool bars fit into it; the others go into a list of their bar.

/**
 * @typedef {object} Fitted a button as the row sees it
 * @property {number} bar number of its bar in the row
 * @property {number} rank the highest goes first where there is little room; 0 = never
 * @property {number} width [px]
 */

/**
 * Whether each button of a row is in sight.
 *
 * A bar that lacks some is wider by the button that opens its list.
 * @param {Fitted[]} buttons of all bars of the row
 * @param {{width: number, gap: number, more: number}} room of the row, between its bars, and of
 *   the button that opens a list [px]
 */
export function fitting(buttons, { width, gap, more }) {
  const shown = buttons.map(() => true);
  const leaving = buttons
    .map(({ rank }, k) => ({ rank, k }))
    .filter(({ rank }) => rank > 0)
    .sort((one, other) => other.rank - one.rank);
  const bars = new Set(buttons.map(({ bar }) => bar));
  const needed = () =>
    buttons.reduce((sum, one, k) => sum + (shown[k] ? one.width : 0), 0) +
    more * new Set(buttons.filter((_, k) => !shown[k]).map(({ bar }) => bar)).size +
    gap * (bars.size - 1);
  for (const { k } of leaving) {
    if (needed() <= width) break;
    shown[k] = false;
  }
  return shown;
}
