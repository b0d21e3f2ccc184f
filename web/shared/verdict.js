// The verdict on a map as text. No DOM, no network.

import { decimal, t, wordOf } from "./texts.js";

/**
 * @import {MapVerdict, Unobserved} from "./http_types"
 * @typedef {import("./http_types").SaidFinding} MapFinding
 * @typedef {object} MapFacts what is known of a map
 * @property {MapVerdict | null} verdict null = none was worked out
 * @property {string[]} notes what does not change the verdict
 * @property {MapFinding[] | null} findings worst first; null = an earlier version made the map
 * @property {Record<string, any>} [figures] those of the run, with `duration_s`
 */

/** Captions of the levels of findings, the worst first. */
/** @type {Record<string, string>} */
export const LEVELS = {
  "do not use": t("level-do-not-use"),
  check: t("level-check"),
  note: t("level-note"),
  good: t("level-good"),
};

/** What a project's summary says of its map; null before there is one. */
export const factsIn = (/** @type {Record<string, any> | null | undefined} */ summary) =>
  summary?.points === undefined
    ? null
    : {
        verdict: summary.verdict ?? null,
        notes: notesIn(summary),
        findings: summary.findings ?? null,
        figures: { duration_s: summary.duration_s },
      };

/** Texts of notes; before format 3 the run wrote warnings. */
const notesIn = (
  /** @type {{findings?: MapFinding[], warnings?: string[]}} */ { findings, warnings },
) =>
  findings
    ? findings.filter(({ level }) => level === "note").map(({ text }) => text)
    : (warnings ?? []);

/** The badge of a verdict, by its name in STATES. */
/** @type {Record<string, import("./format.js").StateName>} */
const STATES = { good: "sound", check: "check", "do not use": "unusable" };
export const verdictState = (/** @type {MapVerdict | null} */ verdict) =>
  STATES[verdict?.usability ?? ""] ?? "unjudged";

const place = (/** @type {number[]} */ [x, y, z]) =>
  t("place-xyz", { x: decimal(x, 1), y: decimal(y, 1), z: decimal(z, 1) });

const horizontal = (/** @type {string} */ direction) =>
  t("direction-some", { direction: wordOf("direction", direction) });

/** When, where and in which direction the LiDAR hardly observes the motion. */
export function unobservedText(
  /** @type {Unobserved} */ { start_s, end_s, direction, degeneracy, from_m, to_m },
) {
  const times = t("span-s", { start: start_s.toFixed(0), end: end_s.toFixed(0) });
  const known = direction === "vertical" ? t("direction-vertical") : horizontal(direction);
  const which = direction ? known : t("direction-one");
  const what = t("unobserved", { which, degeneracy: decimal(degeneracy, 4) });
  const where =
    from_m?.length && to_m?.length
      ? t("unobserved-where", { from: place(from_m), to: place(to_m) })
      : "";
  return `${times}: ${what}${where}`;
}

/**
 * All that is to be known of a map, as titled lists without the empty ones.
 * @param {MapFacts} facts
 * @returns {Array<[string, string[]]>}
 */
export function verdictLists({ verdict, notes }) {
  const reasons = verdict?.reasons ?? [];
  /** @type {Array<[string, string[]]>} */
  const lists = [
    [t("findings"), reasons],
    [t("hardly-observable"), (verdict?.unobserved ?? []).map(unobservedText)],
    [t("notes"), notes.filter((text) => !reasons.includes(text))],
  ];
  return lists.filter(([, texts]) => texts.length > 0);
}

/** The first of what is to be known of a map in one line; empty if there is nothing. */
export const firstText = (/** @type {MapFacts} */ facts) =>
  facts.findings ? (facts.findings[0]?.text ?? "") : (verdictLists(facts)[0]?.[1][0] ?? "");

/** The stretch of a finding as the viewer reads it in a fragment; empty = the whole walk. */
export const stretchOf = (/** @type {Partial<MapFinding>} */ { span_s, place_m }) =>
  [span_s && `span=${span_s.join(",")}`, place_m && `place=${place_m.flat().join(",")}`]
    .filter(Boolean)
    .join("&");

/** Duration of the walk [s]; 0 = unknown. */
export const durationOf = (/** @type {MapFacts} */ { figures }) => Number(figures?.duration_s) || 0;

/** The span that an address marks, as in a fragment or query of ours; empty = none. */
export const spanIn = (/** @type {{hash: string, search: string}} */ { hash, search }) =>
  new URLSearchParams(hash.slice(1)).get("span") ?? new URLSearchParams(search).get("span") ?? "";

const LEAST_VIEW_M = 10;
const VIEW_PX = 500;

/** The query of the slices page: a horizontal slice at the place of a finding, which it marks. */
export function sliceOf(/** @type {Partial<MapFinding>} */ { place_m, span_s }) {
  if (!place_m) return "";
  const [[x0, y0, z0], [x1, y1, z1]] = place_m;
  const view_m = Math.max(LEAST_VIEW_M, 1.5 * Math.hypot(x1 - x0, y1 - y0));
  const numbers = { z: (z0 + z1) / 2, u: (x0 + x1) / 2, v: (y0 + y1) / 2, m: view_m / VIEW_PX };
  const fields = Object.entries(numbers).map(([name, value]) => `${name}=${value.toFixed(3)}`);
  const times = span_s ? `&span=${span_s.join(",")}` : "";
  return `kind=horizontal&${fields.join("&")}&mark=${place_m.flat().join(",")}${times}`;
}

/** When or where the stretch of a finding is. */
export function stretchText(/** @type {Partial<MapFinding>} */ { span_s, place_m }) {
  if (!span_s) return place(place_m?.[0] ?? []);
  const [start, end] = span_s.map((second) => decimal(second, 1));
  return start === end ? `${start} s` : t("span-s", { start, end });
}

/**
 * Whether a text is long enough as a reason to approve a map in spite of its verdict.
 * @param {string} text
 * @param {{reason_needed: string, min_reason_characters: number}} given
 */
export const isReason = (text, { reason_needed, min_reason_characters }) =>
  !reason_needed || text.trim().length >= min_reason_characters;
