// The time axis of a walk, on which each finding marks its stretch.

import { html, nothing } from "./dom.js";
import { stretchText } from "./verdict.js";
import { rowsOf, ticksOf } from "./walk_rows.js";
import { t } from "./texts.js";

/** @import {MapFinding} from "./verdict.js" */

/**
 * The axis; nothing if no finding has a stretch, or the duration is unknown.
 * @param {MapFinding[]} findings
 * @param {number} duration_s
 * @param {(finding: MapFinding) => boolean} isChosen whether it is the marked one
 */
export function walkAxis(findings, duration_s, isChosen) {
  const rows = duration_s > 0 ? rowsOf(findings, duration_s) : [];
  if (!rows.length) return nothing;
  const texts = rows.flat().map(({ finding }) => `${finding.kind} ${stretchText(finding)}`);
  return html`<div
    class="walk-axis"
    role="img"
    aria-label=${t("walk-axis", { end: duration_s.toFixed(0), findings: texts.join(", ") })}
  >
    ${rows.map(
      (row) =>
        html`<div class="row">
          ${row.map(
            ({ finding, left, width }) =>
              html`<i
                class="${finding.level.replaceAll(" ", "-")} ${isChosen(finding) ? "chosen" : ""}"
                title="${finding.title}, ${stretchText(finding)}"
                .style="left: ${left}%; width: ${width}%"
              ></i>`,
          )}
        </div>`,
    )}
    <div class="ticks">
      ${ticksOf(duration_s).map(
        (s) => html`<span .style="left: ${(100 * s) / duration_s}%">${s} s</span>`,
      )}
    </div>
  </div>`;
}
