// The first image of the map. It needs a third of the modules of the page; the others are read when
// it has been drawn, else they take its processor time.

import { idHere } from "../shared/address.js";
import { pointReader, readMapIndex } from "../shared/api/map.js";
import { byId } from "../shared/dom.js";
import { MapCanvas } from "./map_canvas.js";
import * as shown from "./page.js";
import { first, seenOn } from "./sight.js";

/** @import {Camera} from "./camera.js" */

const { page } = shown;
/** What runs: the canvas, the timer of the address, the turn of the camera. */
export const run = { canvas: /** @type {MapCanvas | null} */ (null), address: 0, turn: 0 };
export const dark = matchMedia("(prefers-color-scheme: dark)");

/** The values that the points are colored by; empty = by their places. */
export const storedOf = () =>
  /** @type {import("./tiles.js").Stored | ""} */ (
    page.index?.columns.find(({ name }) => name === shown.colorShown())?.name ?? ""
  );

/** What is drawn by the state of the page. */
export const drawingOf = (/** @type {Camera} */ camera) => ({
  camera,
  color: shown.colorShown(),
  ends: shown.endsShown().ends,
  planes: shown.planes(),
  depth: page.state.depth,
  size: page.state.size,
  dark: dark.matches,
  layers: {
    walk: page.state.layers.includes("walk"),
    nodes: page.state.layers.includes("nodes"),
  },
});

/** Hides what says that there is no image yet. */
export function hideOpening(/** @type {MapCanvas} */ { drawn }) {
  byId("opening").hidden ||= drawn.points > 0 || drawn.rested;
}

async function open() {
  const id = idHere();
  const index = await readMapIndex(id);
  page.index = index;
  if (page.state.cutCeiling) page.state.clip.heights = shown.usualHeights(index);
  const canvas = new MapCanvas(byId("map", HTMLCanvasElement), index, pointReader(id, index));
  canvas.drawing = drawingOf(page.state.camera ?? first(seenOn(canvas.screen)));
  const sampled = canvas.tiles.readSample(storedOf());
  sampled.catch(() => {}); // the page says it
  run.canvas = canvas;
  return { canvas, sampled };
}

/** When the first image is complete, or cannot be. */
async function firstImage() {
  const { canvas, sampled } = await opened;
  await sampled;
  if (document.hidden) return; // nothing is drawn
  await new Promise((done) => {
    canvas.onDrawn = () => canvas.drawn.frames && done(hideOpening(canvas));
  });
}

/** Reads the rest of the page. */
function readOn() {
  document.head.append(byId("later", HTMLTemplateElement).content);
}

/** For tests: what is shown and drawn. */
Object.assign(window, { recon4Map: { page, run } });
/** The canvas, and its sample that is being read. */
export const opened = open();
firstImage().then(readOn, readOn);
