// What was exported of a map: rows that stay when their files are removed.

import { exportUrl } from "../shared/api.js";
import { badge } from "../shared/badge.js";
import { html, nothing, repeat } from "../shared/dom.js";
import { bytes, when } from "../shared/format.js";
import { optionWords } from "./export_options.js";

/**
 * @import {ExportChoices, ExportView} from "../shared/http_types"
 * @typedef {object} RowActions
 * @property {(row: ExportView) => unknown} cancel
 * @property {(row: ExportView) => unknown} remove
 */

/**
 * @param {string} project
 * @param {ExportView[]} rows
 * @param {{classes: ExportChoices["classes"], mine: (row: ExportView) => boolean}} known
 * @param {RowActions} actions
 */
export const exportList = (project, rows, known, actions) =>
  rows.length === 0
    ? html`<p class="quiet">Nothing was exported yet.</p>`
    : html`<ul class="exports">
        ${repeat(
          rows,
          (row) => row.id,
          (row) => exportRow(project, row, known, actions),
        )}
      </ul>`;

/**
 * @param {string} project
 * @param {ExportView} row
 * @param {{classes: ExportChoices["classes"], mine: (row: ExportView) => boolean}} known
 * @param {RowActions} actions
 */
function exportRow(project, row, known, actions) {
  const open = row.state === "queued" || row.state === "running";
  const words = optionWords(row.options, known.classes);
  const { made } = row;
  const title =
    made && row.kept
      ? html`<a href=${exportUrl(project, row.id)} download>${row.title}</a>`
      : html`<strong>${row.title}</strong>`;
  const button = (/** @type {string} */ text, /** @type {() => unknown} */ action) =>
    html`<button type="button" aria-label=${`${text}: ${row.title}`} @click=${action}>
      ${text}
    </button>`;
  return html`<li class=${row.kept ? "kept" : ""}>
    <div class="export-head">
      ${title} ${made ? html`<span class="quiet">${bytes(made.bytes)}</span>` : badge(row.state)}
    </div>
    ${open ? progress(row) : nothing}
    ${words.length ? html`<p class="quiet">${words.join(" · ")}</p>` : nothing}
    <p class="quiet">
      ${[made?.text, row.person, when(row.finished || row.created)].filter(Boolean).join(" · ")}
    </p>
    ${made ? details(row) : nothing} ${row.note ? html`<p class="quiet">${row.note}</p>` : nothing}
    <div class="buttons">
      ${open && known.mine(row) ? button("Cancel", () => actions.cancel(row)) : nothing}
      ${row.kept && known.mine(row) ? button("Remove file", () => actions.remove(row)) : nothing}
    </div>
  </li>`;
}

const progress = (/** @type {ExportView} */ { state, what, fraction }) =>
  html`<progress
      max="1"
      aria-label="Progress of this file"
      .value=${fraction ?? 0}
      ?hidden=${state !== "running"}
    ></progress>
    <p class="quiet">${state === "running" ? what || "Starting" : "Waits for other exports"}</p>`;

const details = (/** @type {ExportView} */ { made, kept, of_this_map }) =>
  made
    ? html`<p class="quiet">
          ${made.approval}${of_this_map ? nothing : " · of an earlier map"}${
            kept ? nothing : " · the file was removed: order it again"
          }
        </p>
        <details>
          <summary>Hash and version</summary>
          <dl class="hashes">
            <dt>File</dt>
            <dd>${made.name}</dd>
            <dt>SHA-256</dt>
            <dd><code>${made.sha256}</code></dd>
            <dt>recon4</dt>
            <dd>${made.recon4}</dd>
          </dl>
        </details>`
    : nothing;
