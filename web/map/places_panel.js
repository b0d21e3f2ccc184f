// What the panel of the map says of findings and of marks of the operator.

import { html, nothing } from "../shared/dom.js";
import { stretchUrl } from "../shared/api.js";
import { idHere } from "../shared/address.js";
import { t } from "../shared/texts.js";
import { findingPins, operatorPins, page } from "./page.js";
import { timesOf } from "./places.js";

/**
 * @import {Act} from "./bar.js"
 * @import {Pin} from "./places.js"
 */

/** Findings and marks with a place; each flies there. */
export function placesSections(/** @type {Act} */ act) {
  const [findings, marks] = [findingPins(), operatorPins()];
  const leftOut = page.walk?.marks_left_out ?? 0;
  return html`${
    findings.length
      ? html`<section aria-labelledby="findings-title">
          <h2 id="findings-title">${t("findings-count", { count: findings.length })}</h2>
          ${list(findings, act)}
        </section>`
      : nothing
  }
  ${
    marks.length || leftOut
      ? html`<section aria-labelledby="marks-title">
          <h2 id="marks-title">${t("marks-count", { count: marks.length })}</h2>
          ${list(marks, act)}
          ${
            leftOut
              ? html`<p class="quiet">${t("marks-left-out", { count: leftOut })}</p>`
              : nothing
          }
        </section>`
      : nothing
  }`;
}

const list = (/** @type {Pin[]} */ pins, /** @type {Act} */ act) =>
  html`<ul class="rows">
    ${pins.map((pin) => {
      const { kind, name, text, level, mark } = pin;
      const here = page.chosen?.kind === kind && page.chosen.name === name;
      return html`<li>
        <button
          type="button"
          class="place ${level}"
          aria-pressed=${String(here)}
          @click=${() => act.choosePin(pin)}
        >
          ${text.split(": ")[0]} <small>${timesOf(mark)}</small></button
        >${
          here && kind === "finding" && mark.span
            ? html`<a
                class="button"
                href=${stretchUrl(idHere(), `span=${mark.span.join(",")}`)}
                aria-label=${t("stretch-in-graph")}
                >${t("graph")}</a
              >`
            : nothing
        }
      </li>`;
    })}
  </ul>`;
