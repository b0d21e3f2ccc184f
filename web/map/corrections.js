// Correct classes: what is inside the clip box, or painted, gets another class.

import { idHere } from "../shared/address.js";
import "../shared/class_corrections.js";
import { detailOf, html } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { paintedVolume } from "./brush.js";
import { brushFields } from "./brush_fields.js";
import { page } from "./page.js";

/**
 * @import {Volume} from "../shared/class_corrections.js"
 * @import {MapIndex} from "../shared/http_types"
 * @import {Act} from "./bar.js"
 * @import {Clip} from "./clip.js"
 */

/**
 * The clip box between the heights that are shown, as the server expects it; null = there is none.
 * @param {Clip} clip
 * @returns {Volume | null}
 */
export function volumeOf({ box, heights: [lowest, highest], section }) {
  if (!box || section) return null;
  const [x, y, z] = box.center;
  const low = Math.max(z - box.size[2] / 2, lowest ?? -Infinity);
  const high = Math.min(z + box.size[2] / 2, highest ?? Infinity);
  if (!(high > low)) return null;
  const [c, s] = [Math.cos(box.yaw), Math.sin(box.yaw)];
  return {
    shape: "box",
    center_m: [x, y, (low + high) / 2],
    size_m: [box.size[0], box.size[1], high - low],
    u: [c, s, 0],
    v: [-s, c, 0],
  };
}

const hintOf = (/** @type {Clip} */ { box, section }) =>
  section ? t("hint-section") : box ? t("hint-empty") : t("hint-box");

/**
 * The section of the panel.
 * @param {MapIndex} index
 * @param {Act} act
 */
export const corrections = ({ key }, act) =>
  html`<section aria-labelledby="classes-title">
    <h2 id="classes-title">${t("correct-classes")}</h2>
    ${brushFields(act)}
    <div class="buttons">
      <button type="button" aria-pressed=${page.tool === "like"} @click=${() => act.tool("like")}>
        ${t("all-like-this")}
      </button>
    </div>
    <class-corrections
      .given=${{
        project: idHere(),
        map: key,
        volume: paintedVolume() ?? volumeOf(page.state.clip),
        hint: hintOf(page.state.clip),
        place: page.like.place,
      }}
      @alike=${(/** @type {Event} */ event) => {
        page.like.boxes = detailOf(event);
        act.change({});
      }}
      @look=${(/** @type {Event} */ event) => act.goTo(detailOf(event))}
      @forget=${() => {
        page.like = { place: null, boxes: [] };
        act.change({});
      }}
      @applied=${() => {
        page.brush.strokes = [];
        page.like = { place: null, boxes: [] };
        act.change({});
      }}
    ></class-corrections>
  </section>`;
