// The first rows of a table of coordinates, what each column is taken for, and the question.

import { make } from "../shared/dom.js";

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

/** A list to choose from; `onValue(value)` is called when a person chooses. */
export function choice(ariaLabel, options, value, onValue) {
  const element = make(
    "select",
    { ariaLabel },
    ...options.map(([key, text]) => make("option", { value: key }, text)),
  );
  element.value = value;
  element.addEventListener("change", () => onValue(element.value));
  return element;
}

/** What is missing before the columns can be used; empty = nothing. */
export function missing(columns) {
  const bare = columns.map((one) => (one.length > 1 ? one.replace("-", "") : one));
  const count = (meaning) => bare.filter((one) => one === meaning).length;
  const degrees = count("lat") + count("lon") > 0;
  const axes = degrees ? ["lat", "lon", "z"] : ["x", "y", "z"];
  const label = Object.fromEntries(MEANINGS);
  const open = axes.filter((axis) => count(axis) !== 1);
  if (open.length) return `Choose one column each as ${open.map((one) => label[one]).join("; ")}`;
  return degrees && count("x") + count("y") ? "Choose either degrees or x and y" : "";
}

/**
 * The rows with a list above each column; `changed(columns, unit)` is called for each change;
 * `unit` is null unless it was chosen.
 *
 * @param {import("../shared/http_types").TablePreview} table
 * @param {(columns: string[], unit: string | null) => void} changed
 */
export function columnTable(table, changed) {
  const columns = [...table.columns];
  const width = Math.max(columns.length, ...table.rows.map((row) => row.length));
  while (columns.length < width) columns.push("-");
  const name = (k) => table.header[k] || `column ${k + 1}`;
  const pick = (k) =>
    choice(`Meaning of ${name(k)}`, MEANINGS, columns[k], (meaning) => {
      // A coordinate has one column: the one that had this meaning before is free again.
      const next = columns.map((old, j) => (j !== k && old === meaning ? "-" : old));
      next[k] = /** @type {any} */ (meaning);
      changed(next, null);
    });
  const all = Array.from({ length: width }, (_, k) => k);
  return make(
    "div",
    { className: "table-columns" },
    table.question
      ? make("p", { className: "bad", role: "alert" }, `Not certain: ${table.question}`)
      : make("p", { className: "quiet" }, table.description),
    make(
      "div",
      { className: "scroll" },
      make(
        "table",
        {},
        make(
          "thead",
          {},
          make("tr", {}, ...all.map((k) => make("th", { scope: "col" }, name(k)))),
          make("tr", {}, ...all.map((k) => make("td", {}, pick(k)))),
        ),
        make(
          "tbody",
          {},
          ...table.rows.map((row) =>
            make("tr", {}, ...all.map((k) => make("td", { className: "number" }, row[k] ?? ""))),
          ),
        ),
      ),
    ),
    make(
      "p",
      { className: "row" },
      choice("Unit of the coordinates", UNITS, table.unit, (unit) => changed(columns, unit)),
      make(
        "span",
        { className: "quiet" },
        `The first ${table.rows.length} rows; separated by "${table.delimiter}", ` +
          `decimal "${table.decimal}"`,
      ),
    ),
  );
}
