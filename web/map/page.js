// What the page of the map knows and shows, and the clip that follows from it.

import { decimal, t } from "../shared/texts.js";
import { parse } from "./state.js";
import { planesOf } from "./clip.js";
import { lineOf } from "./places.js";

/**
 * @import {
 *   MapIndex, MapNote, MapVolume, MapWalk, ProjectView, SavedMapView, Storey
 * } from "../shared/http_types"
 * @import {ColorBy} from "./state.js"
 * @import {MapFinding} from "../shared/verdict.js"
 * @import {Pin} from "./places.js"
 * @import {ProfileView} from "./profile.js"
 * @import {NoteDraft} from "./notes.js"
 * @typedef {"" | "measure" | "box" | "section" | "stand" | "note" | "brush" | "like"} Tool
 */

const CUT_M = 2.2; // above the floor: frames of rooms stay, ceilings go
const BELOW_M = 0.4; // what is below the floor of a storey and still shown with it

export const page = {
  state: parse(location.search),
  /** @type {MapIndex | null} */
  index: null,
  /** @type {ProjectView | null} */
  project: null,
  guest: false, // somebody with a guest link
  mayShare: false,
  mayProcess: false, // notes and saved views
  /** @type {MapWalk | null} */
  walk: null,
  /** @type {Tool} */
  tool: "",
  /** @type {import("./measure.js").MeasureKind} */
  measuring: "distance",
  /** @type {Array<{p: number[], sd: number, crs: number[] | null, snap: string}>} */
  draft: [],
  snapping: true,
  /** What was painted to get another class: strokes of places, and the radius of the brush [m]. */
  brush: { radius: 0.1, strokes: /** @type {number[][][]} */ ([]) },
  /** A thing that was picked [m], and the boxes of all that are like it. */
  like: {
    place: /** @type {number[] | null} */ (null),
    boxes: /** @type {import("../shared/alike.js").Box[]} */ ([]),
  },
  /** By keyboard: whether the cross is shown, and where a drag began [m]. */
  aim: { on: false, from: /** @type {number[] | null} */ (null) },
  /** @type {Record<string, MapVolume | Error | null>} by their points and base; null = asked for */
  volumes: {},
  /** @type {ProfileView | null} */
  profile: null,
  /** @type {number[][] | null} */
  drag: null,
  /** What a pick or a tool says. */
  reading: /** @type {string | (() => string)} */ (""),
  /** @type {Pin | null} */
  chosen: null,
  panel: innerWidth > 800,
  saved: { all: /** @type {SavedMapView[]} */ ([]) },
  notes: {
    all: /** @type {MapNote[]} */ ([]),
    filter: "",
    draft: /** @type {NoteDraft | null} */ (null),
    problem: /** @type {unknown} */ (null),
  },
  flight: { on: false, time: 0, speed: 4 },
};

/** Lowest and highest point that the heights of the clip leave [m]. */
export function heightsShown() {
  const { index, state } = page;
  const [low, high] = state.clip.heights;
  /** @type {[number, number]} */
  return /** @type {[number, number]} */ ([
    low ?? index?.low_m[2] ?? 0,
    high ?? index?.high_m[2] ?? 1,
  ]);
}

/** The heights of a storey; with its floor if it is chosen, else all below its ceiling. */
export const heightsOf = (/** @type {Storey} */ { floor_m }, alone = true) =>
  /** @type {[number | null, number]} */ ([alone ? floor_m - BELOW_M : null, floor_m + CUT_M]);

/** The heights at first: without the ceiling of the top storey, if it has one. */
export function usualHeights(/** @type {MapIndex} */ { storeys }) {
  const top = storeys.at(-1);
  return top?.ceiling ? heightsOf(top, false) : /** @type {[null, null]} */ ([null, null]);
}

/** Clip planes of what is shown. */
export const planes = () => planesOf(page.state.clip);

/** By what the points are colored. */
export function colorShown() {
  const { index, state } = page;
  const names = index?.columns.map(({ name }) => /** @type {string} */ (name)) ?? [];
  const { color } = state;
  if (color && (["height", "plain"].includes(color) || names.includes(color))) return color;
  if (color === "class" && index && Object.keys(index.classes).length) return color;
  return index?.color ?? "height";
}

/** Colors that this map can be shown in. */
export const colorsOf = (/** @type {MapIndex} */ index) =>
  /** @type {ColorBy[]} */ ([
    ...["normalized", "intensity"].filter((name) => index.columns.some((one) => one.name === name)),
    "height",
    ...(Object.keys(index.classes).length ? ["class"] : []),
    ...["time", "uncertainty", "thickness"].filter((name) =>
      index.columns.some((one) => one.name === name),
    ),
    "plain",
  ]);

/** Ends of the colors, and their unit. */
export function endsShown() {
  const { index, state } = page;
  const color = colorShown();
  const column = index?.columns.find(({ name }) => name === color);
  const [low, high] = heightsShown();
  const usual = column ? [column.low, column.high] : [low, high];
  const unit = column ? column.unit : "m";
  const ends = /** @type {[number, number]} */ ([state.lo ?? usual[0], state.hi ?? usual[1]]);
  return { ends, unit };
}

/** The findings with a place, at its middle. @returns {Pin[]} */
export function findingPins() {
  /** @type {MapFinding[]} */
  const found = /** @type {any} */ (page.project?.summary.findings ?? []);
  return found.flatMap(({ place_m, span_s, level, title, text }, k) => {
    const mark = { span: span_s, place: place_m ?? [] };
    const line = lineOf(mark, page.walk);
    if (!line.length) return [];
    const p = line[line.length >> 1];
    const about = { level: level.replaceAll(" ", "-"), text: `${title}: ${text}` };
    return [{ kind: "finding", p, ...about, name: `${title} ${k}`, mark }];
  });
}

/** What the operator marked. @returns {Pin[]} */
export const operatorPins = () =>
  (page.walk?.marks ?? []).map(({ t_s, p_map, text, who }, k) => ({
    kind: "mark",
    p: p_map,
    level: "",
    text: [text || t("mark-of-operator"), who, `${decimal(t_s, 1)} s`].filter(Boolean).join(" · "),
    name: String(k),
    mark: { span: [t_s, t_s], place: [p_map, p_map] },
  }));

/** The notes that the filter leaves. */
export const notesListed = () => {
  const { all, filter } = page.notes;
  return all.filter(({ status }) => !filter || status === filter);
};

const xyz = (/** @type {number[]} */ [x, y, z]) =>
  /** @type {[number, number, number]} */ ([x, y, z]);

const notePin = (/** @type {Pick<MapNote, "id" | "p_map" | "status" | "text">} */ note) =>
  /** @type {Pin} */ ({
    kind: "note",
    p: note.p_map,
    level: note.status,
    text: note.text,
    name: note.id,
    mark: { span: null, place: [note.p_map, note.p_map] },
  });

/** Notes that are listed, and the one that is written, at their places. */
export function notePins() {
  const { draft } = page.notes;
  const begun =
    draft && !draft.id ? [notePin({ ...draft, p_map: xyz(draft.p), status: "open" })] : [];
  return [...notesListed().map(notePin), ...begun];
}

/** The pins of the layers that are shown. */
export function pinsShown() {
  const { layers } = page.state;
  return [
    ...(layers.includes("findings") ? findingPins() : []),
    ...(layers.includes("marks") ? operatorPins() : []),
    ...(layers.includes("notes") ? notePins() : []),
  ];
}
