// What the page of the map knows and shows, and the clip that follows from it.

import { parse } from "./state.js";
import { planesOf } from "./clip.js";

/**
 * @import {MapIndex, MapWalk, ProjectView, Storey} from "../shared/http_types"
 * @import {ColorBy} from "./state.js"
 * @import {SavedView} from "./views.js"
 * @typedef {"" | "measure" | "box" | "section" | "stand"} Tool
 */

const CUT_M = 2.2; // above the floor: frames of rooms stay, ceilings go
const BELOW_M = 0.4; // what is below the floor of a storey and still shown with it

export const page = {
  state: parse(location.search),
  /** @type {MapIndex | null} */
  index: null,
  /** @type {ProjectView | null} */
  project: null,
  /** @type {MapWalk | null} */
  walk: null,
  /** @type {Tool} */
  tool: "",
  /** @type {import("./measure.js").MeasureKind} */
  measuring: "distance",
  /** @type {Array<{p: number[], sd: number, crs: number[] | null}>} */
  draft: [],
  /** @type {number[][] | null} */
  drag: null,
  reading: "",
  panel: innerWidth > 800,
  /** @type {SavedView[]} */
  saved: [],
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
  return /** @type {ColorBy} */ (
    ["normalized", "intensity"].find((name) => names.includes(name)) ?? "height"
  );
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

/** The findings with a place, at its middle. */
export function findingPlaces() {
  /** @type {Array<{place_m?: number[][] | null, level: string, title: string}>} */
  const found = /** @type {any} */ (page.project?.summary.findings ?? []);
  return found.flatMap(({ place_m, level, title }) =>
    place_m
      ? [
          {
            p: [0, 1, 2].map((k) => (place_m[0][k] + place_m[1][k]) / 2),
            level: level.replaceAll(" ", "-"),
            text: title,
          },
        ]
      : [],
  );
}
