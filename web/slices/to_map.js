// The page of the map with the plane of a slice. No DOM, no network.

/** @import {SliceState} from "./state.js" */

/**
 * The query of the map's page that shows a slice in 3-D.
 * @param {SliceState} slice a free plane is not shown
 * @param {string} [before] query with which the map was left: colors, layers, measurements
 */
export function mapQuery({ kind, z, a, b, t }, before = "") {
  const text = (/** @type {number} */ x) => String(Number(x.toFixed(3)));
  const section = [...a, ...b, t].map(text).join(",");
  const query = new URLSearchParams(before);
  if (kind !== "vertical" || query.get("section") !== section)
    for (const name of ["camera", "standing", "box", "section", "z"]) query.delete(name);
  if (kind === "horizontal") query.set("z", `${text(z - t / 2)}..${text(z + t / 2)}`);
  if (kind === "vertical" && !query.has("section")) {
    query.set("section", section);
    query.set("z", "..");
  }
  return query.size ? `?${query.toString().replaceAll("%2C", ",")}` : "";
}
