// What the page of the map shows of another map, in the address. No DOM, no network.

/**
 * @typedef {object} Compared
 * @property {string} id of the comparison; empty = none
 * @property {number | null} reach distance at the ends of the colors [m]; null = the usual one
 * @property {number | null} swipe where the divider is, as a part of the width; null = differences
 */

const ID = /^[0-9a-f]{16}$/;

/** @type {Compared} */
export const NOT_COMPARED = { id: "", reach: null, swipe: null };

const within = (/** @type {string | null} */ text, /** @type {[number, number]} */ [low, high]) => {
  const value = text === null || text.trim() === "" ? NaN : Number(text);
  return value >= low && value <= high ? value : null;
};

/** What an address shows; what is not valid becomes the usual. @returns {Compared} */
export function comparedIn(/** @type {URLSearchParams} */ given) {
  const id = given.get("compare") ?? "";
  if (!ID.test(id)) return NOT_COMPARED;
  const mm = within(given.get("reach"), [0.1, 10_000]);
  const swipe = within(given.get("swipe"), [0, 1]);
  return { id, reach: mm === null ? null : mm / 1000, swipe };
}

/**
 * Adds what is shown to the query of an address.
 * @param {Compared} compared
 * @param {URLSearchParams} query
 */
export function comparedQuery({ id, reach, swipe }, query) {
  if (!id) return;
  query.set("compare", id);
  if (reach !== null) query.set("reach", String(Number((1000 * reach).toFixed(3))));
  if (swipe !== null) query.set("swipe", String(Number(swipe.toFixed(3))));
}
