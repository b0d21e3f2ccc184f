// The form of a delivery: which files are in it, the license of the data, the language.

import { html, nothing, repeat } from "../shared/dom.js";
import { bytes, when } from "../shared/format.js";
import { language, languages, t, wordOf } from "../shared/texts.js";
import { optionWords } from "./export_options.js";

/**
 * @import {ExportChoices, ExportView, NewDelivery} from "../shared/http_types"
 * @typedef {object} Packed what the fields hold
 * @property {string[]} files kinds that are made now
 * @property {string[]} exports ids of files that were exported before
 * @property {string} license
 * @property {string} language
 */

export const DELIVERY = "delivery.zip";

/** @returns {Packed} */
export const usualDelivery = () => ({
  files: ["map.copc.laz", "findings.csv"],
  exports: [],
  license: "",
  language: language(),
});

/** Exports of the present map that a delivery can hold. */
export const packable = (/** @type {ExportView[]} */ rows) =>
  rows.filter((row) => row.kept && row.of_this_map && row.file !== DELIVERY);

/**
 * What the server is asked for; throws an error with words if nothing is chosen.
 * @param {Packed} packed
 * @param {ExportView[]} rows
 * @returns {NewDelivery}
 */
export function deliveryOf({ files, exports, license, language: spoken }, rows) {
  const there = packable(rows).map((row) => row.id);
  const chosen = exports.filter((id) => there.includes(id));
  if (!files.length && !chosen.length) throw new Error(t("delivery-choose"));
  return { files, exports: chosen, license, language: spoken };
}

/**
 * Takes what a field of the form says.
 * @param {Packed} packed
 * @param {HTMLInputElement} field
 * @returns {boolean} whether it is one of a delivery
 */
export function takeField(packed, { name, value, checked }) {
  if (name === "packed-file" || name === "packed-export") {
    const list = name === "packed-file" ? "files" : "exports";
    const others = packed[list].filter((one) => one !== value);
    packed[list] = checked ? [...others, value] : others;
  } else if (name === "license" || name === "language") packed[name] = value;
  else return false;
  return true;
}

/**
 * @param {Packed} packed
 * @param {ExportChoices} choices
 * @param {ExportView[]} rows
 */
export function deliveryFields(packed, { kinds, classes }, rows) {
  const check = (
    /** @type {{name: string, value: string, on: boolean, text: unknown}} */ {
      name,
      value,
      on,
      text,
    },
  ) =>
    html`<label class="check">
      <input type="checkbox" name=${name} value=${value} .checked=${on} /><span>${text}</span>
    </label>`;
  const made = packable(rows);
  return html`${
      made.length
        ? html`<fieldset>
            <legend>${t("delivery-made-before")}</legend>
            ${repeat(
              made,
              (row) => row.id,
              (row) =>
                check({
                  ...{ name: "packed-export", value: row.id, on: packed.exports.includes(row.id) },
                  text: rowText(row, classes),
                }),
            )}
          </fieldset>`
        : nothing
    }
    <fieldset class="classes">
      <legend>${t("delivery-made-now")}</legend>
      ${kinds
        .filter(({ name }) => name !== DELIVERY)
        .map(({ name, title }) =>
          check({
            ...{ name: "packed-file", value: name, on: packed.files.includes(name) },
            text: wordOf("export", title),
          }),
        )}
    </fieldset>
    <label>
      <span>${t("delivery-license")}</span>
      <textarea
        name="license"
        rows="2"
        maxlength="100000"
        placeholder=${t("delivery-no-license")}
        .value=${packed.license}
      ></textarea>
    </label>
    <label>
      <span>${t("delivery-language")}</span>
      <select name="language">
        ${languages().map(
          ([code, name]) =>
            html`<option value=${code} ?selected=${code === packed.language}>${name}</option>`,
        )}
      </select>
    </label>`;
}

/**
 * @param {ExportView} row
 * @param {ExportChoices["classes"]} classes
 */
const rowText = ({ title, made, options, finished }, classes) =>
  [
    wordOf("export", title),
    made && bytes(made.bytes),
    ...optionWords(options, classes),
    when(finished),
  ]
    .filter(Boolean)
    .join(" · ");
