// How many points of each tile are drawn. Any first points of a tile are an even sample of it, so
// the answer is a count. No DOM, no network.

import { add, axesOf, cornersOf, dot, eyeOf, focalPx, minus } from "./camera.js";

/**
 * @import {Camera, Screen} from "./camera.js"
 * @typedef {object} Box a tile as the choice sees it
 * @property {number[]} low_m
 * @property {number[]} high_m
 * @property {number} points
 * @property {number} sample points that are always drawn
 * @property {number} spacing_m of neighbors if all are drawn
 */

const NEAREST_M = 1; // nearer points of a tile are drawn as those at this distance
const FINEST_PX = 0.9; // neighbors nearer to each other than this do not show
const COARSEST_PX = 1000;
const ENOUGH = 12_000; // points of a response, to which parts of further tiles are added before
const MOST_PARTS = 64; // of a response

/**
 * Whether a box is outside of one of the planes (n, d): n · p + d < 0 in all of it.
 * @param {{low_m: number[], high_m: number[]}} box
 * @param {number[][]} planes
 */
export const isOutside = ({ low_m, high_m }, planes) =>
  planes.some(
    ([x, y, z, d]) =>
      Math.max(x * low_m[0], x * high_m[0]) +
        Math.max(y * low_m[1], y * high_m[1]) +
        Math.max(z * low_m[2], z * high_m[2]) +
        d <
      0,
  );

/**
 * The sides of what the camera sees, as planes.
 * @param {Camera} camera
 * @param {Screen} screen
 */
export function sidesOf(camera, screen) {
  const { right, up, ahead } = axesOf(camera);
  const eye = eyeOf(camera);
  const focal = focalPx(screen);
  const [wide, tall] = [screen.width / 2 / focal, screen.height / 2 / focal];
  const sides = [
    [right, wide],
    [right, -wide],
    [up, tall],
    [up, -tall],
  ];
  return sides.map(([axis, part]) => {
    const [along, by] = /** @type {[number[], number]} */ ([axis, part]);
    const inward = by > 0 ? -1 : 1;
    if (camera.parallel) {
      const n = add([0, 0, 0], along, inward);
      const edge = add(camera.target, along, by * camera.distance);
      return [...n, -dot(n, edge)];
    }
    const n = add(add([0, 0, 0], along, inward), ahead, Math.abs(by));
    return [...n, -dot(n, eye)];
  });
}

/**
 * Distance at which a tile is seen [m].
 * @param {Box} box
 * @param {Camera} camera
 */
export function seenFrom({ low_m, high_m }, camera) {
  if (camera.parallel) return camera.distance;
  const eye = eyeOf(camera);
  const away = [0, 1, 2].map((k) => Math.max(low_m[k] - eye[k], eye[k] - high_m[k], 0));
  return Math.max(Math.hypot(...away), NEAREST_M);
}

/**
 * How many points of each tile are drawn within a budget: as few as the finest distance of
 * neighbors on screen asks for, the same for all tiles, and none of those out of sight.
 * @param {Box[]} tiles
 * @param {{camera: Camera, screen: Screen, planes: number[][], budget: number}} view
 */
export function choose(tiles, { camera, screen, planes, budget }) {
  const hidden = [...sidesOf(camera, screen), ...planes];
  const seen = tiles.map((tile) => !isOutside(tile, hidden));
  const apartPx = tiles.map((tile) => (tile.spacing_m * focalPx(screen)) / seenFrom(tile, camera));
  const counts = (/** @type {number} */ px) =>
    tiles.map((tile, k) => {
      if (!seen[k]) return 0;
      const wanted = Math.ceil(tile.points * (apartPx[k] / px) ** 2);
      return Math.min(tile.points, Math.max(tile.sample, wanted));
    });
  const sum = (/** @type {number[]} */ all) => all.reduce((total, one) => total + one, 0);
  let [fine, coarse] = [FINEST_PX, COARSEST_PX];
  if (sum(counts(fine)) <= budget) return { counts: counts(fine), px: fine };
  for (let round = 0; round < 24; round++) {
    const middle = Math.sqrt(fine * coarse);
    if (sum(counts(middle)) <= budget) coarse = middle;
    else fine = middle;
  }
  return { counts: counts(coarse), px: coarse };
}

/**
 * The next part of a tile to read: as many points again as there are, or twice what is wanted of
 * a tile of which few are, but never more than `most`.
 * @param {number} have
 * @param {number} wanted
 * @param {number} points all of the tile
 */
export function nextPart(have, wanted, points, most = 120_000, least = 12_000) {
  if (have >= Math.min(wanted, points)) return null;
  const few = Math.min(least, 2 * wanted - have);
  const stop = Math.min(points, have + Math.min(most, Math.max(have, few)));
  return { start: have, stop: points - stop < few ? points : stop };
}

/**
 * Takes the parts of the next response from the front of a queue.
 * @template {{start: number, stop: number}} Part
 * @param {Part[]} queue
 */
export function takeParts(queue) {
  let [count, points] = [0, 0];
  while (count < Math.min(queue.length, MOST_PARTS) && points < ENOUGH) {
    points += queue[count].stop - queue[count].start;
    count++;
  }
  return queue.splice(0, count);
}

/**
 * The tiles whose next part is read first: those whose neighbors are farthest apart on screen.
 * @param {Box[]} tiles
 * @param {{counts: number[], have: number[]}} shown
 * @param {Camera} camera
 */
export function readingOrder(tiles, { counts, have }, camera) {
  const apart = (/** @type {number} */ k) =>
    (tiles[k].spacing_m * Math.sqrt(tiles[k].points / Math.max(have[k], 1))) /
    seenFrom(tiles[k], camera);
  return tiles
    .map((_, k) => k)
    .filter((k) => counts[k] > have[k])
    .sort((a, b) => apart(b) - apart(a));
}

/**
 * The nearest and the farthest depth of a box ahead of the eye [m].
 * @param {Camera} camera
 * @param {{low: number[], high: number[]}} box
 */
export function depthsOf(camera, { low, high }) {
  const { ahead } = axesOf(camera);
  const eye = eyeOf(camera);
  const all = cornersOf(low, high).map((corner) => dot(minus(corner, eye), ahead));
  return { near: Math.min(...all), far: Math.max(...all) };
}
