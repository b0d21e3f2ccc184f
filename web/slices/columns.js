// The first rows of a table of coordinates, what each column is taken for, and the question.

import { html, targetOf } from "../shared/dom.js";
import { t } from "../shared/texts.js";

/**
 * @import {TablePreview} from "../shared/http_types"
 * @typedef {TablePreview["columns"]} Columns
 * @typedef {TablePreview["unit"]} Unit
 */

/** @type {Array<[string, string]>} */
const MEANINGS = [
  ["-", t("column-none")],
  ["id", t("column-id")],
  ["x", t("column-x")],
  ["y", t("column-y")],
  ["z", t("column-z")],
  ["-x", t("column-minus-x")],
  ["-y", t("column-minus-y")],
  ["lat", t("column-lat")],
  ["lon", t("column-lon")],
  ["role", t("column-role")],
  ["radius", t("column-radius")],
  ["se", t("column-sd", { axis: "E" })],
  ["sn", t("column-sd", { axis: "N" })],
  ["sh", t("column-sd", { axis: "H" })],
  ["cee", t("column-cov", { axis: "EE" })],
  ["cen", t("column-cov", { axis: "EN" })],
  ["ceh", t("column-cov", { axis: "EH" })],
  ["cnn", t("column-cov", { axis: "NN" })],
  ["cnh", t("column-cov", { axis: "NH" })],
  ["chh", t("column-cov", { axis: "HH" })],
];

/** @type {Array<[string, string]>} */
export const UNITS = [
  ["m", t("unit-m")],
  ["mm", t("unit-mm")],
  ["cm", t("unit-cm")],
  ["dm", t("unit-dm")],
  ["km", t("unit-km")],
  ["ft", t("unit-ft")],
  ["us-ft", t("unit-us-ft")],
  ["in", t("unit-in")],
];

/**
 * A list to choose from; `onValue(value)` is called when a person chooses.
 * @param {string} label
 * @param {Array<[string, string]>} options value and caption of each
 * @param {string | undefined} value
 * @param {(value: string) => void} onValue
 */
export const choice = (label, options, value, onValue) =>
  html`<select
    aria-label=${label}
    @change=${(/** @type {Event} */ event) => onValue(targetOf(event).value)}
  >
    ${options.map(
      ([key, text]) => html`<option value=${key} .selected=${key === value}>${text}</option>`,
    )}
  </select>`;

/** What is missing before the columns can be used; empty = nothing. */
export function missing(/** @type {string[]} */ columns) {
  const bare = columns.map((one) => (one.length > 1 ? one.replace("-", "") : one));
  const count = (/** @type {string} */ meaning) => bare.filter((one) => one === meaning).length;
  const degrees = count("lat") + count("lon") > 0;
  const axes = degrees ? ["lat", "lon", "z"] : ["x", "y", "z"];
  /** @type {Record<string, string>} */
  const label = Object.fromEntries(MEANINGS);
  const open = axes.filter((axis) => count(axis) !== 1);
  if (open.length)
    return t("choose-columns", { columns: open.map((one) => label[one]).join("; ") });
  return degrees && count("x") + count("y") ? t("degrees-or-xy") : "";
}

/**
 * The rows with a list above each column; `changed(columns, unit)` is called for each change;
 * `unit` is null unless it was chosen.
 *
 * @param {TablePreview} table
 * @param {(columns: Columns, unit: Unit | null) => void} changed
 */
export function columnTable(table, changed) {
  const columns = [...table.columns];
  const width = Math.max(columns.length, ...table.rows.map((row) => row.length));
  while (columns.length < width) columns.push("-");
  const name = (/** @type {number} */ k) => table.header[k] || t("column-n", { n: k + 1 });
  const pick = (/** @type {number} */ k) =>
    choice(t("meaning-of", { column: name(k) }), MEANINGS, columns[k], (meaning) => {
      // A coordinate has one column: the one that had this meaning before is free again.
      const next = columns.map((old, j) => (j !== k && old === meaning ? "-" : old));
      next[k] = /** @type {any} */ (meaning);
      changed(next, null);
    });
  const all = Array.from({ length: width }, (_, k) => k);
  const question = table.question
    ? html`<p class="bad" role="alert">${t("not-certain", { question: table.question })}</p>`
    : html`<p class="quiet">${table.description}</p>`;
  return html`<div class="table-columns">
    ${question}
    <div class="scroll">
      <table>
        <thead>
          <tr>
            ${all.map((k) => html`<th scope="col">${name(k)}</th>`)}
          </tr>
          <tr>
            ${all.map((k) => html`<td>${pick(k)}</td>`)}
          </tr>
        </thead>
        <tbody>
          ${table.rows.map(
            (row) =>
              html`<tr>
                ${all.map((k) => html`<td class="number">${row[k] ?? ""}</td>`)}
              </tr>`,
          )}
        </tbody>
      </table>
    </div>
    <p class="row">
      ${choice(t("unit-of-coordinates"), UNITS, table.unit, (unit) =>
        changed(columns, /** @type {Unit} */ (unit)),
      )}<span class="quiet"
        >${t("first-rows", {
          rows: table.rows.length,
          delimiter: table.delimiter,
          decimal: table.decimal,
        })}</span
      >
    </p>
  </div>`;
}
