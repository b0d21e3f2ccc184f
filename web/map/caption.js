// The caption of the map, and the list of its keys.

import { approvalWords } from "../shared/approval.js";
import { html, nothing, render } from "../shared/dom.js";
import { count } from "../shared/format.js";
import { frameText } from "../shared/frame.js";
import { keyList } from "../shared/keys.js";
import { t } from "../shared/texts.js";
import { KINDS } from "./measure.js";
import { page } from "./page.js";

/** @import {Act} from "./bar.js" */

/** @type {Array<[string, string]>} */
export const KEYS = [
  [t("key-drag"), t("do-drag")],
  [t("key-sideways"), t("do-sideways")],
  [t("key-wheel"), t("do-wheel")],
  [t("key-double"), t("do-double")],
  [t("key-fingers"), t("do-fingers")],
  [t("key-arrows"), t("do-arrows")],
  [t("key-space"), t("do-space")],
  ["+ -", t("do-zoom")],
  ["F", t("do-fit")],
  ["5 7 1 2 3 4", t("do-views")],
  ["O", t("do-parallel")],
  ["M H A Q I", t("do-measure")],
  ["R V", t("do-profile")],
  ["S", t("do-snap")],
  ["Enter", t("do-enter")],
  ["⌫", t("do-undo-point")],
  ["B", t("do-box")],
  ["X", t("do-section")],
  ["K", t("do-brush")],
  ["J", t("do-like")],
  ["Z", t("do-ceilings")],
  ["C", t("do-color")],
  ["N", t("do-note")],
  ["G", t("do-stand")],
  ["P", t("do-fly")],
  ["W", t("do-walk")],
  ["L", t("do-link")],
  ["T", t("do-panel")],
  ["Esc", t("do-esc")],
];

/**
 * @param {HTMLElement} element
 * @param {{points: number, rested: boolean, scale: string}} drawn
 * @param {Act} act
 */
export function drawStatus(element, { points, rested, scale }, act) {
  const { index, project, flight } = page;
  if (!index) return;
  const reading = typeof page.reading === "function" ? page.reading() : page.reading;
  const shown =
    t("points-shown", { shown: count(points), count: count(index.points) }) + (rested ? "" : " …");
  render(
    html`<div role="status">${reading ? html`<p class="reading">${reading}</p>` : nothing}</div>
      ${ending(act)}
      <p class="caption">
        <span class="shown">${shown}</span> · <span>${scale}</span
        ><span class="frame"> · ${frameText(index.frame)}</span>
        ${project ? html` · <span>${approvalWords(project.approval)}</span>` : nothing}
        ${
          flight.on
            ? html` · <span>${t("s-of-walk", { s: flight.time.toFixed(0) })}</span>`
            : nothing
        }
      </p>`,
    element,
  );
}

/** What Enter, Backspace and Esc do, for fingers. */
function ending(/** @type {Act} */ { finish, undoPoint, end }) {
  const { tool, measuring, draft } = page;
  if (tool === "") return nothing;
  const { least, most } = KINDS[measuring];
  const open = tool === "measure" && least < most && draft.length >= least;
  return html`<div class="ending">
    ${
      open
        ? html`<button type="button" class="primary" @click=${finish}>${t("finish-tool")}</button>`
        : nothing
    }
    ${
      tool === "measure" && draft.length
        ? html`<button type="button" @click=${undoPoint}>${t("undo-point")}</button>`
        : nothing
    }
    <button type="button" @click=${end}>${t("end-tool")}</button>
  </div>`;
}

export const drawHelp = (/** @type {HTMLElement} */ dialog) =>
  render(
    html`<h2 id="help-title" tabindex="-1" autofocus>${t("keys")}</h2>
      ${keyList(KEYS)}
      <form method="dialog"><button class="primary">${t("close")}</button></form>`,
    dialog,
  );
