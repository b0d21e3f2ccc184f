// The list of measurements in the panel of the map, and as a file.

import { idHere } from "../shared/address.js";
import { putIntoCrs } from "../shared/api.js";
import { html, nothing, repeat, targetOf } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { resultOf, toCsv } from "./measure.js";
import { numberField } from "./number_field.js";
import { page } from "./page.js";
import { volumeOf, volumeProblem } from "./volumes.js";

/**
 * @import {Act} from "./bar.js"
 * @import {Measurement} from "./measure.js"
 */

const SAVED_MS = 1500; // until then a browser has begun to save

/** Saves all measurements as CSV. */
export async function downloadMeasurements() {
  const { index, state } = page;
  const points = state.measurements.flatMap((one) => one.points);
  const p_map = /** @type {[number, number, number][]} */ (points);
  const there = index?.crs ? await putIntoCrs(idHere(), { key: index.key, p_map }) : null;
  const text = toCsv(state.measurements, there, volumeOf);
  const file = document.createElement("a");
  file.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  file.download = `${idHere()}-measurements.csv`;
  file.click();
  setTimeout(() => URL.revokeObjectURL(file.href), SAVED_MS);
}

/** The section of the panel. */
export function measuredSection(/** @type {Act} */ act) {
  const { measurements: all } = page.state;
  const set = (/** @type {Measurement[]} */ next) => act.change({ measurements: next });
  const rows = all.map((one, k) => ({ one, k }));
  return html`<section aria-labelledby="measured-title">
    <h2 id="measured-title">${t("measurements")}</h2>
    <label class="check"
      ><input type="checkbox" .checked=${page.snapping} @change=${act.snapping} /><span
        >${t("snap-to")}</span
      ></label
    >
    ${
      all.length
        ? html`<ol class="rows">
              ${repeat(
                rows,
                ({ k }) => k,
                ({ one, k }) => row(one, k, act),
              )}
            </ol>
            <div class="buttons">
              <button type="button" @click=${act.csv}>${t("download-csv")}</button
              ><button type="button" @click=${() => set([])}>${t("remove-all")}</button>
            </div>`
        : html`<p class="quiet">${t("no-measurements")}</p>`
    }
  </section>`;
}

/**
 * @param {Measurement} one
 * @param {number} at
 * @param {Act} act
 */
function row(one, at, act) {
  const all = page.state.measurements;
  const set = (/** @type {Partial<Measurement>} */ next) =>
    act.change({ measurements: all.map((each, k) => (k === at ? { ...each, ...next } : each)) });
  const { value, parts } = resultOf(one, volumeOf(one));
  const problem = volumeProblem(one);
  return html`<li>
    <input
      aria-label=${t("name")}
      .value=${one.name}
      maxlength="80"
      @change=${(/** @type {Event} */ event) => set({ name: targetOf(event).value })}
    />
    ${
      problem
        ? html`<small class="error">${problem}</small>`
        : html`<b class="value">${value}</b><small>${parts}</small>`
    }
    ${
      one.kind === "volume"
        ? numberField(t("base-height"), one.figure ?? null, (figure) => set({ figure }), {
            usual: t("base-fitted"),
          })
        : nothing
    }
    <span class="buttons"
      >${
        one.kind === "profile"
          ? html`<button type="button" @click=${() => act.profile.show(one)}>${t("show")}</button>`
          : nothing
      }<button type="button" @click=${() => act.goTo(one.points[0])}>${t("go-to")}</button
      ><button
        type="button"
        @click=${() => act.change({ measurements: all.filter((_, k) => k !== at) })}
      >
        ${t("remove")}
      </button></span
    >
  </li>`;
}
