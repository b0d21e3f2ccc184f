// What is chosen of an export, as the server takes it. No DOM, no network.

import { clipWords } from "./export_clip.js";
import { asWritten, t, wordOf } from "../shared/texts.js";

/**
 * @import {ExportChoices, ExportKind, ExportOptions, NewExport} from "../shared/http_types"
 * @typedef {object} Chosen what the fields hold
 * @property {string} file
 * @property {string} crs
 * @property {"map" | "all" | "some"} points
 * @property {number[]} classes
 * @property {string} storey
 * @property {string[]} box six texts
 * @property {string[]} clip boxes of seven numbers, as in an address
 * @property {string} thin in mm
 * @property {string} pixel in mm
 * @property {string} cell in m
 * @property {boolean} raw
 * @property {boolean} draft
 */

const CLIP_NUMBERS = 7; // middle, edges, turn

/** @returns {Chosen} */
export const usual = () => ({
  file: "map.copc.laz",
  crs: "",
  points: "map",
  classes: [],
  storey: "",
  box: ["", "", "", "", "", ""],
  clip: [],
  thin: "",
  pixel: "10",
  cell: "0.25",
  raw: false,
  draft: false,
});

/**
 * The order for the server; throws an error with words if a field cannot be read.
 * @param {Chosen} chosen
 * @param {ExportKind} kind
 * @returns {NewExport}
 */
export function orderOf(chosen, kind) {
  const takes = (/** @type {string} */ name) => kind.takes.includes(name);
  /** @type {Partial<ExportOptions>} */
  const options = {};
  if (takes("crs") && chosen.crs) options.crs = chosen.crs;
  if (takes("storey") && chosen.storey) options.storey = chosen.storey;
  if (takes("raw") && chosen.raw) options.raw = true;
  if (takes("draft") && chosen.draft) options.draft = true;
  if (takes("all_points") && chosen.points === "all") options.all_points = true;
  if (takes("classes") && chosen.points === "some") options.classes = someClasses(chosen.classes);
  if (takes("box_m") && chosen.box.some(Boolean)) options.box_m = boxOf(chosen.box);
  if (takes("clip") && chosen.clip.length) options.clip = chosen.clip.map(clipBoxOf);
  if (takes("thin_m") && chosen.thin)
    options.thin_m = number(chosen.thin, t("thin-out-brief")) / 1000;
  if (takes("pixel_m")) options.pixel_m = number(chosen.pixel, t("pixel")) / 1000;
  if (takes("cell_m")) options.cell_m = number(chosen.cell, t("cell"));
  return { file: kind.name, options };
}

function someClasses(/** @type {number[]} */ classes) {
  if (!classes.length) throw new Error(t("classes-choose"));
  return [...classes].sort((a, b) => a - b);
}

function boxOf(/** @type {string[]} */ texts) {
  const box = texts.map((text) => number(text, t("box")));
  return /** @type {[number, number, number, number, number, number]} */ (box);
}

/** A box of an address. */
export function clipBoxOf(/** @type {string} */ text) {
  const box = text.split(",").map((part) => number(part, t("clip-part")));
  if (box.length !== CLIP_NUMBERS) throw new Error(t("clip-wrong", { text }));
  return /** @type {[number, number, number, number, number, number, number]} */ (box);
}

function number(/** @type {string} */ text, /** @type {string} */ field) {
  const value = Number(text.trim().replace(",", "."));
  if (!text.trim() || !Number.isFinite(value)) throw new Error(t("not-a-number", { field, text }));
  return value;
}

/** What an order leaves of a map, in words. */
export function optionWords(
  /** @type {ExportOptions} */ {
    crs,
    raw,
    all_points,
    classes = [],
    box_m,
    clip = [],
    storey,
    thin_m = 0,
    draft,
  },
  /** @type {ExportChoices["classes"]} */ known,
) {
  const title = (/** @type {number} */ code) =>
    wordOf(
      "class",
      known.find((one) => one.code === code)?.title ?? t("class-number", { code: String(code) }),
    );
  return [
    crs,
    storey && t("option-storey", { storey }),
    box_m && t("option-box", { corners: box_m.map(asWritten).join(t("list-gap")) }),
    ...clipWords(clip),
    all_points && t("option-all"),
    classes.length > 0 && classes.map(title).join(", "),
    thin_m > 0 && t("option-thin", { mm: asWritten(+(thin_m * 1000).toFixed(3)) }),
    raw && t("option-raw"),
    draft && t("option-draft"),
  ].filter(Boolean);
}
