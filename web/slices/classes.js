// Correct classes: a polygon in the slice, as thick as it, or a brush, gives its points another
// class.

import { detailOf, html, nothing, render, targetOf } from "../shared/dom.js";
import "../shared/class_corrections.js";
import { t } from "../shared/texts.js";
import { RADII_M } from "../shared/brush_limits.js";
import { brushVolume } from "./brush.js";
import { axesOf } from "./state.js";

/**
 * @import {Volume} from "../shared/class_corrections.js"
 * @import {SliceFacts} from "../shared/http_types"
 * @import {Panel, SlicesPage} from "./findings.js"
 * @import {SliceState} from "./state.js"
 */

/**
 * The polygon through the slice as the server expects it; null = it has no area yet.
 * @param {SliceState} state
 * @param {Array<[number, number]>} corners
 * @returns {Volume | null}
 */
function prismOf(state, corners) {
  if (corners.length < 3) return null;
  const half = state.t / 2;
  return { shape: "prism", polygon_m: corners, low_m: -half, high_m: half, ...axesOf(state) };
}

/**
 * Fills the panel of classes.
 * @param {HTMLElement} host
 * @param {SlicesPage} page
 * @returns {Panel}
 */
export function classesPanel(host, { id, state, outline, brush, like, point }) {
  const map = { key: "", known: false };

  function draw() {
    const { corners, drawing } = outline();
    const { on, radius, strokes } = brush();
    const resize = (/** @type {Event} */ event) => {
      const m = Number(targetOf(event).value);
      brush({ radius: Math.min(RADII_M.most, Math.max(RADII_M.least, m || radius)) });
    };
    const liking = like();
    const earlier = state().source !== "";
    const button = (
      /** @type {string} */ text,
      /** @type {() => void} */ action,
      { disabled = false, pressed = /** @type {boolean | null} */ (null) } = {},
    ) =>
      html`<button
        type="button"
        aria-pressed=${pressed ?? nothing}
        ?disabled=${disabled}
        @click=${action}
      >
        ${text}
      </button>`;
    render(
      html`<p>${t("polygon-is")}</p>
        ${
          earlier
            ? html`<p class="quiet">${t("choose-this-map")}</p>`
            : html`<div class="buttons">
                  ${button(t("draw-polygon"), () => outline("draw"), { pressed: drawing })}
                  ${button(t("remove-corner"), () => outline("back"), {
                    disabled: !corners.length,
                  })}
                  ${button(t("remove-polygon"), () => outline("clear"), {
                    disabled: !corners.length,
                  })}
                </div>
                <div class="buttons">
                  ${button(t("brush"), () => brush({ on: !on }), { pressed: on })}
                  ${button(t("remove-strokes"), () => brush({ strokes: [] }), {
                    disabled: !strokes.length,
                  })}
                </div>
                <div class="buttons">
                  ${button(t("all-like-this"), () => like({ on: !liking.on }), {
                    pressed: liking.on,
                  })}
                </div>
                <div class="correction-fields">
                  <label
                    ><span>${t("brush-radius")}</span
                    ><input
                      type="number"
                      step="0.05"
                      min=${RADII_M.least}
                      max=${RADII_M.most}
                      .value=${String(radius)}
                      @change=${resize}
                  /></label>
                </div>`
        }
        <class-corrections
          .given=${{
            project: id,
            map: map.key,
            volume: earlier ? null : (brushVolume(state(), brush()) ?? prismOf(state(), corners)),
            hint: t("polygon-hint"),
            place: earlier ? null : liking.place,
          }}
          @alike=${(/** @type {Event} */ event) => like({ boxes: detailOf(event) })}
          @look=${(/** @type {Event} */ event) => point(detailOf(event))}
          @forget=${() => like({ place: null, boxes: [] })}
          @applied=${() => {
            outline("clear");
            brush({ on: false, strokes: [] });
            like({ place: null, boxes: [] });
          }}
        ></class-corrections>`,
      host,
    );
  }

  return {
    show: () => {
      if (map.known) draw();
    },
    facts: (/** @type {SliceFacts} */ facts) => {
      map.known = true;
      if (state().source === "") map.key = facts.key;
      draw();
    },
  };
}
