// The legend of a slice: colors with their range, which may be changed. No network.

import { html, nothing, targetOf } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { COLORS } from "./state.js";

/**
 * @import {SliceFacts, SliceImageView} from "../shared/http_types"
 * @import {SliceState} from "./state.js"
 * @typedef {(low: number | null, high: number | null) => void} OnRange
 */

/** @type {Record<string, string>} */
const UNITS = { height: "m", time: "s", distance: "cm" };

/**
 * The legend; `onRange(low, high)` when a person changes its ends, nulls = automatic.
 * @param {SliceState} state
 * @param {SliceImageView} shown
 * @param {SliceFacts} facts
 * @param {OnRange} onRange
 */
export function legend(state, shown, facts, onRange) {
  const unit = UNITS[state.color] ? ` [${UNITS[state.color]}]` : "";
  const reference =
    facts.references.find((one) => one.id === state.ref)?.name ?? t("reference-name");
  return html`<span class="what">${COLORS[state.color]}${unit}</span>
    ${state.color === "sensor" ? swatches(shown, facts) : ramp(state, shown, onRange)}
    ${state.ref ? html`<span class="reference"><i></i>${reference}</span>` : nothing}`;
}

/**
 * A color for each sensor.
 * @param {SliceImageView} shown
 * @param {SliceFacts} facts
 */
function swatches({ colors }, { sensors }) {
  const names = sensors.length ? sensors : ["1", "2"];
  return names.map(
    (name, k) =>
      html`<span class="swatch"
        ><i .style=${`background: ${colors[k % colors.length]}`}></i>${name}</span
      >`,
  );
}

/**
 * The range of the colors, with its ends as fields.
 * @param {SliceState} state
 * @param {SliceImageView} shown
 * @param {OnRange} onRange
 */
function ramp({ color, lo, hi }, { colors, low, high }, onRange) {
  const scale = color === "distance" ? 100 : 1;
  const end = (
    /** @type {string} */ label,
    /** @type {number} */ value,
    /** @type {(x: number) => [number, number]} */ rangeOf,
  ) => {
    const change = (/** @type {Event} */ event) => {
      const x = targetOf(event).valueAsNumber / scale;
      const range = rangeOf(x);
      targetOf(event).blur();
      if (Number.isFinite(x) && range[1] > range[0]) onRange(...range);
    };
    const text = String(Number((value * scale).toPrecision(4)));
    return html`<input
      type="number"
      step="any"
      aria-label=${label}
      .value=${text}
      @change=${change}
    />`;
  };
  return html`${end(t("low-end"), low, (x) => [x, hi ?? high])}<span
      class="ramp"
      .style=${`background: linear-gradient(90deg, ${colors.join(", ")})`}
    ></span
    >${end(t("high-end"), high, (x) => [lo ?? low, x])}
    ${
      lo !== null || hi !== null
        ? html`<button type="button" @click=${() => onRange(null, null)}>
            ${t("usual-range")}
          </button>`
        : nothing
    }`;
}
