// A survey file before its points are used: its columns, where it lies, and the decision.

import { html, nothing } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { columnTable, missing } from "./columns.js";
import { firstPoint } from "./survey_file.js";

/**
 * @import {ControlPreview} from "../shared/http_types"
 * @import {Columns, Unit} from "./columns.js"
 * @typedef {{file: File, found: ControlPreview, unit: Unit | null}} Preview of a survey file
 * @typedef {object} PreviewActions
 * @property {(columns: Columns, unit: Unit | null) => unknown} read the file again
 * @property {(shown: Preview) => unknown} show without reading it
 * @property {() => unknown} use
 * @property {(text: string, action: () => unknown, how?: {className?: string}) => unknown} button
 */

const MAX_SKIPPED = 5;
/** @type {Record<string, Columns[number]>} */
const SWAPPED = { x: "y", y: "x", "-x": "-y", "-y": "-x" };

/** Whether the points lie in the map; else they have coordinates of their own. */
const place = (/** @type {ControlPreview} */ { lies }, /** @type {string} */ crs) =>
  lies === "map" ? t("lies-map") : lies === "crs" ? t("lies-crs", { crs }) : t("lies-own");

/**
 * @param {Preview} preview
 * @param {string} crs of the map
 * @param {PreviewActions} actions
 */
export function surveyPreview({ file, found, unit }, crs, { read, show, use, button }) {
  const changed = (/** @type {Columns} */ columns, /** @type {Unit | null} */ other) => {
    const open = missing(columns);
    if (!open) return read(columns, other ?? unit);
    const table = { ...found.table, columns, question: `${open}.` };
    return show({ file, found: { ...found, points: [], table }, unit: other ?? unit });
  };
  const swapped = found.table.columns.map((one) => SWAPPED[one] ?? one);
  const count = found.points.length;
  return html`${columnTable(found.table, changed)}
    <p>${firstPoint(found)}</p>
    ${count ? html`<p>${place(found, crs)}</p>` : nothing}
    ${found.skipped.slice(0, MAX_SKIPPED).map((text) => html`<p class="error">${text}</p>`)}
    <div class="buttons">
      ${count ? button(t("use-points", { count }), use, { className: "primary" }) : nothing}
      ${button(t("swap"), () => read(swapped, unit))}
    </div>`;
}
