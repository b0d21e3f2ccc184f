// How many points of each node are drawn. Any first points of a node are an even sample of it, so
// the answer is a count. No DOM, no network.

import { add, axesOf, cornersOf, dot, eyeOf, focalPx, minus } from "./camera.js";

/**
 * @import {Camera, Screen} from "./camera.js"
 * @import {MapNode} from "./nodes.js"
 */

const NEAREST_M = 1; // nearer points of a tile are drawn as those at this distance
const FINEST_PX = 0.9; // neighbors nearer to each other than this do not show
const COARSEST_PX = 1000;
const ENOUGH = 30_000; // points of a response, to which parts of further tiles are added before
const ENOUGH_OF_CUBES = 48_000; // those are only copied from a file
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
 * Distance at which a box is seen [m].
 * @param {{low_m: number[], high_m: number[]}} box
 * @param {Camera} camera
 */
function seenFrom({ low_m, high_m }, camera) {
  return camera.parallel ? camera.distance : awayFrom({ low_m, high_m }, eyeOf(camera));
}

/**
 * @param {{low_m: number[], high_m: number[]}} box
 * @param {number[]} eye
 */
function awayFrom({ low_m, high_m }, eye) {
  const [x, y, z] = [0, 1, 2].map((k) => Math.max(low_m[k] - eye[k], eye[k] - high_m[k], 0));
  return Math.max(Math.hypot(x, y, z), NEAREST_M);
}

/**
 * How many points of each node are drawn within a budget: as few as the finest distance of
 * neighbors on screen asks for, the same for all tiles, and none of those out of sight.
 * @param {MapNode[]} nodes
 * @param {{camera: Camera, screen: Screen, planes: number[][], budget: number}} view
 */
export function choose(nodes, view) {
  const shares = sharesOf(nodes, view);
  const { budget } = view;
  const sum = (/** @type {number} */ px) => {
    let points = 0;
    for (let k = 0; k < nodes.length; k++) points += wantedOf(nodes[k], shares[k], px);
    return points;
  };
  let [fine, coarse] = [FINEST_PX, COARSEST_PX];
  if (sum(fine) <= budget) coarse = fine;
  for (let round = 0; round < 24 && coarse > fine; round++) {
    const middle = Math.sqrt(fine * coarse);
    if (sum(middle) <= budget) coarse = middle;
    else fine = middle;
  }
  return { counts: nodes.map((node, k) => wantedOf(node, shares[k], coarse)), px: coarse };
}

/**
 * Part of the points of each node, and of what is below it, with which neighbors are a pixel
 * apart; 0 = nothing of it is seen. What a tile asks for is asked of its cube, too.
 * @param {MapNode[]} nodes
 * @param {{camera: Camera, screen: Screen, planes: number[][]}} view
 */
function sharesOf(nodes, { camera, screen, planes }) {
  const hidden = [...sidesOf(camera, screen), ...planes];
  const [focal, eye] = [focalPx(screen), eyeOf(camera)];
  const shares = new Float64Array(nodes.length);
  nodes.forEach((node, k) => {
    if (node.cube < 0 || isOutside(node, hidden)) return;
    const away = camera.parallel ? camera.distance : awayFrom(node, eye);
    shares[k] = ((node.spacing_m * focal) / away) ** 2;
    shares[node.cube] = Math.max(shares[node.cube], shares[k]);
  });
  return shares;
}

/**
 * @param {MapNode} node
 * @param {number} share
 * @param {number} px
 */
function wantedOf({ whole, before, sample, points }, share, px) {
  if (!share) return 0;
  const wanted = Math.ceil((whole * share) / (px * px)) - before;
  return Math.min(points, Math.max(sample, wanted));
}

/**
 * The next part of a node to read: what is wanted of it, but twice as much of a node of which
 * there is little, and never more than `most` at once.
 * @param {number} have
 * @param {number} wanted
 * @param {number} points all of the node
 */
export function nextPart(have, wanted, points, most = 60_000, least = 12_000) {
  if (have >= Math.min(wanted, points)) return null;
  const few = Math.min(least, 2 * wanted - have);
  const stop = Math.min(points, have + Math.min(most, Math.max(wanted - have, few)));
  return { start: have, stop: points - stop < few ? points : stop };
}

/**
 * Takes the parts of the next response from the front of a queue: only of cubes, or only of tiles.
 * @template {{start: number, stop: number, ofCube: boolean}} Part
 * @param {Part[]} queue
 */
export function takeParts(queue) {
  const enough = queue[0]?.ofCube ? ENOUGH_OF_CUBES : ENOUGH;
  let [count, points] = [0, 0];
  while (count < Math.min(queue.length, MOST_PARTS) && points < enough) {
    if (queue[count].ofCube !== queue[0].ofCube) break;
    points += queue[count].stop - queue[count].start;
    count++;
  }
  return queue.splice(0, count);
}

/**
 * The nodes whose next part is read first: those whose neighbors are farthest apart on screen.
 * @param {MapNode[]} nodes
 * @param {{counts: number[], have: number[]}} shown
 * @param {Camera} camera
 */
export function readingOrder(nodes, { counts, have }, camera) {
  const apart = new Map();
  nodes.forEach((node, k) => {
    if (counts[k] <= have[k]) return;
    const { spacing_m, whole, before } = node;
    const thinned = Math.sqrt(whole / Math.max(before + have[k], 1));
    apart.set(k, (spacing_m * thinned) / seenFrom(node, camera));
  });
  return [...apart.keys()].sort((a, b) => apart.get(b) - apart.get(a));
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
