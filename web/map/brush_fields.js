// The brush in the panel of the map: its radius, and what was painted.

import { RADII_M } from "../shared/brush_limits.js";
import { html } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { numberField } from "./number_field.js";
import { page } from "./page.js";

/** @import {Act} from "./bar.js" */

/** The buttons of the brush in the panel. */
export function brushFields(/** @type {Act} */ act) {
  const { brush, tool } = page;
  const keep = (/** @type {number[][][]} */ strokes) => () => {
    brush.strokes = strokes;
    act.change({});
  };
  const button = (/** @type {string} */ text, /** @type {() => void} */ action) =>
    html`<button type="button" ?disabled=${!brush.strokes.length} @click=${action}>
      ${text}
    </button>`;
  const resize = (/** @type {number | null} */ m) => {
    brush.radius = Math.min(RADII_M.most, Math.max(RADII_M.least, m ?? brush.radius));
    act.change({});
  };
  return html`${numberField(t("brush-radius"), brush.radius, resize, { step: 0.05 })}
    <div class="buttons">
      <button type="button" aria-pressed=${tool === "brush"} @click=${() => act.tool("brush")}>
        ${t("brush")}
      </button>
      ${button(t("remove-stroke"), keep(brush.strokes.slice(0, -1)))}
      ${button(t("remove-strokes"), keep([]))}
    </div>`;
}
