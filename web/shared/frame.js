// The frame of a map in the language of the page. No DOM, no network.

import { t, written } from "./texts.js";

const LOCAL = "map frame (local), x y z, z up, meters";
const PLACED = /^map frame \(origin at E (\S+) N (\S+) H (\S+) in (.+)\), x y z, z up, meters$/;

/** The frame as the server names it, in words of the page. */
export function frameText(/** @type {string} */ frame) {
  if (frame === LOCAL) return t("frame-local");
  const [, east = "", north = "", up = "", crs = ""] = frame.match(PLACED) ?? [];
  const at = { east: written(east), north: written(north), up: written(up), crs };
  return crs ? t("frame-placed", at) : frame;
}
