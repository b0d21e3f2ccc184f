// The page of the map with the plane of a slice. No DOM, no network.

/** @import {SliceState} from "./state.js" */

/** The query of the map's page that shows the slice in 3-D; empty for a free plane. */
export function mapQuery(/** @type {SliceState} */ { kind, z, a, b, t }) {
  const text = (/** @type {number} */ x) => String(Number(x.toFixed(3)));
  if (kind === "horizontal") return `?z=${text(z - t / 2)}..${text(z + t / 2)}`;
  if (kind === "vertical") return `?section=${[...a, ...b, t].map(text).join(",")}&z=..`;
  return "";
}
