// What was exported of a map: rows that stay when their files are removed.

import { exportUrl } from "../shared/api.js";
import { approvalWords } from "../shared/approval.js";
import { badge } from "../shared/badge.js";
import { html, nothing, repeat } from "../shared/dom.js";
import { bytes, when } from "../shared/format.js";
import { t, wordOf } from "../shared/texts.js";
import { deliveryWords } from "./delivery_check.js";
import { optionWords } from "./export_options.js";
import { stepText } from "./steps.js";

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
    ? html`<p class="quiet">${t("export-nothing")}</p>`
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
  const packed = row.delivery ? deliveryWords(row.delivery) : [];
  const words = [...packed, ...optionWords(row.options, known.classes)];
  const { made } = row;
  const facts = [
    made && contents(made, Boolean(row.delivery)),
    row.person,
    when(row.finished || row.created),
  ];
  const name = wordOf("export", row.title);
  const title =
    made && row.kept
      ? html`<a href=${exportUrl(project, row.id)} download>${name}</a>`
      : html`<strong>${name}</strong>`;
  const button = (/** @type {string} */ text, /** @type {() => unknown} */ action) =>
    html`<button type="button" aria-label=${`${text}: ${name}`} @click=${action}>${text}</button>`;
  return html`<li class=${row.kept ? "kept" : ""}>
    <div class="export-head">
      ${title} ${made ? html`<span class="quiet">${bytes(made.bytes)}</span>` : badge(row.state)}
    </div>
    ${open ? progress(row) : nothing}
    ${words.length ? html`<p class="quiet">${words.join(" · ")}</p>` : nothing}
    <p class="quiet">${facts.filter(Boolean).join(" · ")}</p>
    ${made ? details(row) : nothing} ${row.note ? html`<p class="quiet">${row.note}</p>` : nothing}
    ${
      row.delivery && row.kept ? html`<delivery-check .export=${row.id}></delivery-check>` : nothing
    }
    <div class="buttons">
      ${open && known.mine(row) ? button(t("cancel"), () => actions.cancel(row)) : nothing}
      ${row.kept && known.mine(row) ? button(t("remove-file"), () => actions.remove(row)) : nothing}
    </div>
  </li>`;
}

/** What is in a file, in the language of the page; its record says it in English. */
const contents = (
  /** @type {NonNullable<ExportView["made"]>} */ { points, text },
  /** @type {boolean} */ isDelivery,
) => (points ? t("made-points", { points }) : isDelivery ? "" : text);

const stepName = (/** @type {string} */ what) =>
  what ? wordOf("export", stepText(what)) : t("starting");

const progress = (/** @type {ExportView} */ { state, what, fraction }) =>
  html`<progress
      max="1"
      aria-label=${t("progress-file")}
      .value=${fraction ?? 0}
      ?hidden=${state !== "running"}
    ></progress>
    <p class="quiet">${state === "running" ? stepName(what) : t("export-waits")}</p>`;

const details = (/** @type {ExportView} */ { made, kept, of_this_map }) =>
  made
    ? html`<p class="quiet">
          ${[
            approvalWords(made.approval_line ?? { text: made.approval, code: "", values: {} }),
            of_this_map ? "" : t("export-earlier"),
            kept ? "" : t("export-removed"),
          ]
            .filter(Boolean)
            .join(" · ")}
        </p>
        <details>
          <summary>${t("hash-and-version")}</summary>
          <dl class="hashes">
            <dt>${t("file")}</dt>
            <dd>${made.name}</dd>
            <dt>${t("made-of")}</dt>
            <dd lang="en">${made.text}</dd>
            <dt>SHA-256</dt>
            <dd><code>${made.sha256}</code></dd>
            <dt>recon4</dt>
            <dd>${made.recon4}</dd>
          </dl>
        </details>`
    : nothing;
