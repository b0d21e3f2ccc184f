import assert from "node:assert/strict";
import { test } from "node:test";

import { rayAt } from "../../web/map/camera.js";
import { apartOf } from "../../web/map/density.js";
import {
  choose,
  isOutside,
  nextPart,
  readingOrder,
  sidesOf,
  takeParts,
} from "../../web/map/lod.js";
import { nodesOf, thinnedOf } from "../../web/map/nodes.js";
import { Pace } from "../../web/map/pace.js";

const SCREEN = { width: 800, height: 600 };
const CAMERA = { target: [4, 5, 1], yaw: 0.6, pitch: -0.7, distance: 12, parallel: false };
const PARALLEL = { ...CAMERA, parallel: true };

const near = (a, b) => a.forEach((x, k) => assert.ok(Math.abs(x - b[k]) < 1e-6, `${a} ${b}`));

const tile = (low, points = 100_000, cube = 0) => ({
  low_m: low,
  high_m: low.map((x) => x + 4),
  points,
  sample: 500,
  coarse: 1500,
  cube,
  spacing_m: 0.02,
});
const [NEAR, FAR, BEHIND] = [
  tile([2, 3, -1]),
  tile([30, 40, -1], 100_000, 1),
  tile([-60, -60, -1], 100_000, 2),
];
const TILES = nodesOf([NEAR, FAR, BEHIND]); // three cubes of a tile, then the tiles
const view = (more) => ({ camera: CAMERA, screen: SCREEN, planes: [], budget: 1e9, ...more });

test("near tiles get more points than far ones, hidden ones none", () => {
  const { counts } = choose(TILES, view({}));
  const drawn = [0, 1, 2].map((k) => counts[k] + counts[k + 3]);
  assert.ok(drawn[0] > drawn[1] && drawn[1] >= 500);
  assert.equal(drawn[2], 0);
  assert.equal(counts[0], 1500); // all of a cube before any of its tiles
});

test("the budget holds, and is used", () => {
  const { counts } = choose(TILES, view({ budget: 40_000 }));
  const sum = counts.reduce((all, one) => all + one, 0);
  assert.ok(sum <= 40_000 && sum > 36_000, String(sum));
});

test("tiles that a plane clips wholly get none", () => {
  const { counts } = choose(TILES, view({ planes: [[0, 0, 1, -50]] }));
  assert.deepEqual(counts, [0, 0, 0, 0, 0, 0]);
});

test("few points of many tiles come from their cube alone", () => {
  const many = Array.from({ length: 60 }, (_, k) => tile([20 + 4 * (k % 8), 30 + (k >> 3), -1]));
  const nodes = nodesOf(many);
  const { counts } = choose(nodes, view({ budget: 50_000 }));
  assert.equal(nodes.length, 61);
  assert.deepEqual([nodes[0].whole, nodes[0].points, nodes[0].sample], [6e6, 90_000, 30_000]);
  assert.ok(counts[0] > 40_000 && counts.slice(1).every((count) => count === 0), String(counts));
});

test("a point of a cube is as large as those of its tile that are drawn beside it", () => {
  const nodes = nodesOf([NEAR, tile([6, 3, -1])]);
  const shown = [1500, 22_500, 0]; // half of the cube; of the first tile more

  const sizes = thinnedOf(nodes, 0, (k) => shown[k]);
  near(sizes, [Math.sqrt(100_000 / 23_250), Math.sqrt(100_000 / 750)]);
  near(
    thinnedOf(nodes, 1, (k) => shown[k]),
    [sizes[0]],
  );
});

test("the sides of the image hold what is in it", () => {
  for (const camera of [CAMERA, PARALLEL]) {
    const point = (p) => ({ low_m: p, high_m: p });
    for (const at of [
      [5, 5],
      [795, 595],
      [400, 300],
    ]) {
      const { origin, direction } = rayAt(camera, SCREEN, at);
      const along = camera.parallel ? 1000 : 9;
      const p = origin.map((x, k) => x + along * direction[k]);
      assert.equal(isOutside(point(p), sidesOf(camera, SCREEN)), false);
    }
    const outside = rayAt(camera, SCREEN, [-20, 300]);
    const p = outside.origin.map((x, k) => x + 9 * outside.direction[k]);
    assert.equal(isOutside(point(p), sidesOf(camera, SCREEN)), true);
  }
});

test("parts of a tile follow each other to its end", () => {
  let have = 500;
  const parts = [];
  for (let part; (part = nextPart(have, 100_000, 100_000)); have = part.stop) parts.push(part);
  assert.equal(parts[0].start, 500);
  assert.equal(parts.at(-1).stop, 100_000);
  assert.ok(parts.every((part, k) => k === 0 || part.start === parts[k - 1].stop));
  assert.equal(nextPart(500, 400, 1000), null);
});

test("the coarsest tile on screen is read first", () => {
  const shown = { counts: [0, 1500, 0, 9000, 0, 0], have: [1500, 500, 0, 500, 0, 0] };
  assert.deepEqual(readingOrder(TILES, shown, CAMERA), [3, 1]);
});

test("parts of cubes and of tiles are not in one response", () => {
  const part = (ofCube, stop) => ({ ofCube, start: 0, stop });
  const queue = [part(true, 9000), part(true, 9000), part(false, 9000), part(false, 9000)];
  assert.equal(takeParts(queue).length, 2);
  assert.equal(takeParts(queue).length, 2);
});

test("sparse places have larger points than dense ones", () => {
  const places = new Uint16Array(3 * 2000);
  for (let k = 0; k < 2000; k++) {
    const dense = k < 1900;
    places[3 * k] = dense ? (k * 7919) % 20_000 : 40_000 + ((k * 7919) % 20_000);
    places[3 * k + 1] = (k * 104_729) % 20_000;
  }
  const apart = apartOf(places, {
    low_m: [0, 0, 0],
    high_m: [4, 4, 4],
    points: 2000,
    spacing_m: 0.02,
  });
  const mean = (part) => part.reduce((sum, x) => sum + x, 0) / part.length;
  assert.ok(mean(apart.subarray(1900)) > mean(apart.subarray(0, 1900)) + 15);
});

test("a slow computer loses pixels first, then points; a quick one gets more", () => {
  const pace = new Pace();
  for (let k = 0; k < 3; k++) pace.note(pace.moving, 900);
  assert.ok(pace.sharpness < 0.5 && pace.moving === 300_000);
  for (let k = 0; k < 5; k++) pace.note(pace.moving, 900);
  assert.ok(pace.moving < 150_000);
  for (let k = 0; k < 40; k++) pace.note(pace.moving, 12);
  assert.ok(pace.sharpness === 1 && pace.moving > 2_000_000 && pace.resting >= pace.moving);
});
