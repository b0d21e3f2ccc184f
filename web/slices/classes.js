// Correct classes: a polygon in the slice, as thick as it, gives its points another class.

import { html, nothing, render } from "../shared/dom.js";
import "../shared/class_corrections.js";
import { t } from "../shared/texts.js";
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
export function prismOf(state, corners) {
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
export function classesPanel(host, { id, state, outline }) {
  const map = { key: "", known: false };

  function draw() {
    const { corners, drawing } = outline();
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
              </div>`
        }
        <class-corrections
          .given=${{
            project: id,
            map: map.key,
            volume: earlier ? null : prismOf(state(), corners),
            hint: t("polygon-hint"),
          }}
          @applied=${() => outline("clear")}
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
