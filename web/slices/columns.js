// The first rows of a table of coordinates, what each column is taken for, and the question.

import { html, targetOf } from "../shared/dom.js";

/**
 * @import {TablePreview} from "../shared/http_types"
 * @typedef {TablePreview["columns"]} Columns
 * @typedef {TablePreview["unit"]} Unit
 */

/** @type {Array<[string, string]>} */
export const MEANINGS = [
  ["-", "not used"],
  ["id", "name"],
  ["x", "x, east"],
  ["y", "y, north"],
  ["z", "z, height"],
  ["-x", "minus x (to the west)"],
  ["-y", "minus y (to the south)"],
  ["lat", "latitude [°]"],
  ["lon", "longitude [°]"],
  ["role", "control or check"],
  ["radius", "radius of a target"],
];

/** @type {Array<[string, string]>} */
export const UNITS = [
  ["m", "meters"],
  ["mm", "millimeters"],
  ["cm", "centimeters"],
  ["dm", "decimeters"],
  ["km", "kilometers"],
  ["ft", "international feet"],
  ["us-ft", "US survey feet"],
  ["in", "inches"],
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
  if (open.length) return `Choose one column each as ${open.map((one) => label[one]).join("; ")}`;
  return degrees && count("x") + count("y") ? "Choose either degrees or x and y" : "";
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
  const name = (/** @type {number} */ k) => table.header[k] || `column ${k + 1}`;
  const pick = (/** @type {number} */ k) =>
    choice(`Meaning of ${name(k)}`, MEANINGS, columns[k], (meaning) => {
      // A coordinate has one column: the one that had this meaning before is free again.
      const next = columns.map((old, j) => (j !== k && old === meaning ? "-" : old));
      next[k] = /** @type {any} */ (meaning);
      changed(next, null);
    });
  const all = Array.from({ length: width }, (_, k) => k);
  const question = table.question
    ? html`<p class="bad" role="alert">Not certain: ${table.question}</p>`
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
      ${choice("Unit of the coordinates", UNITS, table.unit, (unit) =>
        changed(columns, /** @type {Unit} */ (unit)),
      )}<span class="quiet"
        >${
          `The first ${table.rows.length} rows; separated by "${table.delimiter}", ` +
          `decimal "${table.decimal}"`
        }</span
      >
    </p>
  </div>`;
}
