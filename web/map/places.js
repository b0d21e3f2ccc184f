// Places that the map points at: findings, marks of the operator, a marked stretch of the walk.
// No DOM, no network.

import { decimal, t } from "../shared/texts.js";
import { add, cornersOf, dot, fitted, toScreen } from "./camera.js";
import { planesOf } from "./clip.js";
import { positionAt } from "./flight.js";

/**
 * @import {MapIndex} from "../shared/http_types"
 * @import {Camera, Screen, View} from "./camera.js"
 * @import {Clip} from "./clip.js"
 * @import {Walk} from "./flight.js"
 * @typedef {object} Mark a stretch of the walk, a place, or both
 * @property {[number, number] | null} span first and last time [s]
 * @property {number[][]} place both ends [m]; empty = not stated
 * @typedef {object} Pin
 * @property {"finding" | "mark" | "note"} kind
 * @property {number[]} p [m]
 * @property {string} text
 * @property {string} level of a finding, status of a note
 * @property {string} name tells it among those of its kind
 * @property {Mark} mark what is shown of it
 */

const AROUND_M = 2.5; // beside a stretch that the camera flies to
const STEEP = -0.6; // looking less steeply, walls hide a place [rad]
const MOST_PIECES = 200;
const PIN_PX = 14;

/**
 * The part of the walk that is marked, or both ends of its place [m].
 * @param {Mark} mark
 * @param {Walk | null} walk
 */
export function lineOf({ span, place }, walk) {
  if (!span || !walk?.t_s.length) return place;
  const [from, to] = span;
  const between = walk.positions_m.filter((_, k) => walk.t_s[k] > from && walk.t_s[k] < to);
  const step = Math.max(1, Math.ceil(between.length / MOST_PIECES));
  return [
    positionAt(walk, from),
    ...between.filter((_, k) => k % step === 0),
    positionAt(walk, to),
  ];
}

/**
 * The camera that shows a line, looking as before but from above.
 * @param {number[][]} line
 * @param {Camera} camera
 * @param {View} view
 * @returns {Camera}
 */
export function cameraAt(line, { yaw, pitch }, view) {
  const end = (/** @type {(...x: number[]) => number} */ most, /** @type {number} */ beside) =>
    [0, 1, 2].map((axis) => most(...line.map((p) => p[axis])) + beside);
  const [low, high] = [end(Math.min, -AROUND_M), end(Math.max, AROUND_M)];
  const { left, right, up, down } = view.free;
  const [side, rim] = [Math.min(left, right), Math.min(up, down)];
  const middle = { screen: view.screen, free: { left: side, right: side, up: rim, down: rim } };
  const look = { yaw, pitch: Math.min(pitch, STEEP), parallel: false };
  const target = add([0, 0, 0], add(low, high), 0.5); // a drag turns about the place
  return { ...fitted(look, middle, cornersOf(low, high)), target };
}

/**
 * A clip that leaves a place: heights of its storey, and no box or section that removes it.
 * @param {Clip} clip
 * @param {number[]} p [m]
 * @param {{index: MapIndex, heightsOf: (storey: any, alone: boolean) => Clip["heights"]}} of
 * @returns {Clip}
 */
export function clipAround(clip, p, { index: { storeys }, heightsOf }) {
  const hides = (/** @type {Clip} */ one) =>
    planesOf(one).some((plane) => dot(plane, p) + plane[3] < 0);
  /** @type {Clip["heights"]} */
  const all = [null, null];
  const box = hides({ heights: all, box: clip.box, section: null }) ? null : clip.box;
  const section = hides({ heights: all, box: null, section: clip.section }) ? null : clip.section;
  const own = storeys.filter(({ floor_m }) => floor_m <= p[2]).at(-1);
  const cut = own && storeys.length > 1 ? heightsOf(own, true) : clip.heights;
  const heights = hides({ heights: cut, box: null, section: null }) ? all : cut;
  return { heights, box, section };
}

/**
 * The pin under a pixel, the nearest to the eye; undefined = none is.
 * @param {Pin[]} pins
 * @param {number[]} at
 * @param {{camera: Camera, screen: Screen}} view
 */
export function pinAt(pins, [x, y], { camera, screen }) {
  const hit = pins.flatMap((pin) => {
    const to = toScreen(camera, screen, pin.p);
    return to && Math.hypot(to.x - x, to.y - PIN_PX / 2 - y) < PIN_PX
      ? [{ pin, depth: to.depth }]
      : [];
  });
  return hit.sort((a, b) => a.depth - b.depth)[0]?.pin;
}

/** The times of a mark in words; empty = it has none. */
export function timesOf(/** @type {Mark} */ { span }) {
  if (!span) return "";
  const [from, to] = span.map((s) => decimal(s, 1));
  return from === to ? `${from} s` : t("seconds-to", { from: from ?? "", to: to ?? "" });
}
