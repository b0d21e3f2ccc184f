// What the page shows at first and after "Fit": all that the clip leaves, where nothing covers it.

import { byId } from "../shared/dom.js";
import { fitted } from "./camera.js";
import { cornersShown, freeOf, frontOf } from "./framing.js";
import { heightsShown, page } from "./page.js";
import { VIEWS } from "./views.js";

/** @import {Camera, Screen, View} from "./camera.js" */

const PANEL_PX = 320;
const CAPTION_PX = 31; // before it is drawn

/** The image, and what of it no bar, panel or caption covers. @returns {View} */
export function seenOn(/** @type {Screen} */ screen) {
  const beside = page.panel && screen.width > 2 * PANEL_PX ? PANEL_PX : 0;
  const [bar, status] = [byId("bar"), byId("status")];
  const above = byId("above").offsetTop + bar.offsetHeight;
  // What a tool says comes and goes above the caption; the image stays where it is.
  const caption = status.querySelector("p.caption");
  const below =
    caption instanceof HTMLElement
      ? screen.height - status.offsetTop - caption.offsetTop
      : CAPTION_PX;
  return { screen, free: freeOf(screen, { above, below, beside }) };
}

/**
 * All that the clip leaves of the map, seen from there.
 * @param {Pick<Camera, "yaw" | "pitch" | "parallel">} look
 * @param {View} view
 */
export function all(look, view) {
  const { index, state } = page;
  if (!index) throw new Error("the map has not been read");
  return fitted(look, view, cornersShown(index, state.clip));
}

/** What a link without a camera shows: its section, or all. */
export function first(/** @type {View} */ view) {
  const { section } = page.state.clip;
  return section
    ? frontOf(section, heightsShown(), view)
    : all({ ...VIEWS.oblique, parallel: false }, view);
}
