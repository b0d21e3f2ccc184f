// What the server says of a reference, in the language of the page. No DOM, no network.

import { t, written } from "../shared/texts.js";

/** @typedef {[RegExp, string]} Sentence its groups are the values of a text */

const LOCAL = new RegExp(
  "^It is in (?<crs>.+); the map is local, " + "so that its coordinates are used unchanged\\.$",
);
/** @type {Sentence[]} */
const SENTENCES = [
  [
    /^✕ The reference does not fit: (?<near>\S+) % of the map is within (?<cm>\S+) cm of it$/,
    "reference-far",
  ],
  [/^– Not judged whether the reference fits: /, "reference-unjudged"],
  [/^none$/, "alignment-none"],
  [/^moved by hand$/, "alignment-by-hand"],
  [
    new RegExp(
      "^ICP, point to plane: (?<near>\\S+) % of the map near it, of these (?<on>\\S+) % on it, " +
        "(?<cm>\\S+) cm from it on average$",
    ),
    "alignment-icp",
  ],
  [/^(?<pairs>\d+) pairs, largest residual (?<cm>\S+) cm \((?<each>.+) cm\)$/, "alignment-pairs"],
  [/^not refined: (?<why>.+)$/, "alignment-not-refined"],
  [/^then (?<how>.+)$/, "alignment-then"],
  [/^In (?<crs>.+), the CRS of the map\.$/, "note-same-crs"],
  [/^Transformed from (?<crs>.+) to (?<own>.+)\.$/, "note-transformed"],
  [LOCAL, "note-local"],
];
const FITS = new RegExp(
  "^(?<sign>✓ The reference fits|✕ The reference does not fit): where both are, " +
    "(?:(?<walls>\\d+) % of the walls)?(?: and )?" +
    "(?:(?<level>\\d+) % of the floors and ceilings)? " +
    "lie within (?<cm>\\S+) cm of a surface of the same orientation$",
);

/**
 * One sentence or part of one; what is not known stays.
 * @param {string} text
 * @returns {string}
 */
function phrase(text) {
  for (const [pattern, id] of SENTENCES) {
    const found = text.match(pattern);
    if (!found) continue;
    const groups = Object.entries(found.groups ?? {});
    return t(id, Object.fromEntries(groups.map(([name, value]) => [name, quoted(name, value)])));
  }
  return text;
}

/**
 * A value of a sentence.
 * @param {string} name
 * @param {string} value
 */
const quoted = (name, value) =>
  name === "how" ? phrase(value) : name === "each" ? listed(value) : number(value);

/** A decimal number as the language writes it; other texts stay. */
const number = (/** @type {string} */ text) => (/^-?\d+\.\d+$/.test(text) ? written(text) : text);
const listed = (/** @type {string} */ text) => text.split(", ").map(number).join(", ");

/** Whether a reference fits. */
export function fitText(/** @type {string} */ text) {
  const found = text.match(FITS)?.groups;
  if (!found) return phrase(text);
  const { sign, walls, level, cm = "" } = found;
  const parts = [
    walls ? t("reference-walls", { percent: walls }) : "",
    level ? t("reference-level", { percent: level }) : "",
  ].filter(Boolean);
  const agree = parts.join(` ${t("and")} `);
  return t(sign?.startsWith("✓") ? "reference-fits" : "reference-misfit", { agree, cm });
}

/** How a reference is aligned. */
export const alignmentText = (/** @type {string} */ text) =>
  text.split("; ").map(phrase).join("; ");

/** What was noticed when it was read. */
export const notesText = (/** @type {string[]} */ notes) => notes.map(phrase).join(" ");
