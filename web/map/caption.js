// The caption of the map, and the list of its keys.

import { approvalWords } from "../shared/approval.js";
import { html, nothing, render } from "../shared/dom.js";
import { count } from "../shared/format.js";
import { frameText } from "../shared/frame.js";
import { t } from "../shared/texts.js";
import { page } from "./page.js";

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
 */
export function drawStatus(element, { points, rested, scale }) {
  const { index, project, reading, flight } = page;
  if (!index) return;
  const shown =
    t("points-shown", { shown: count(points), count: count(index.points) }) + (rested ? "" : " …");
  render(
    html`<div role="status">${reading ? html`<p class="reading">${reading}</p>` : nothing}</div>
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

export const drawHelp = (/** @type {HTMLElement} */ dialog) =>
  render(
    html`<h2 id="help-title" tabindex="-1" autofocus>${t("keys")}</h2>
      <dl class="keys">
        ${KEYS.map(
          ([key, text]) =>
            html`<div>
              <dt>${key}</dt>
              <dd>${text}</dd>
            </div>`,
        )}
      </dl>
      <form method="dialog"><button class="primary">${t("close")}</button></form>`,
    dialog,
  );
