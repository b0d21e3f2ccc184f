import "./english.js";

import assert from "node:assert/strict";
import { test } from "node:test";

import {
  Camera,
  IDENTITY,
  apart,
  apply,
  nudged,
  rotationOf,
  times,
  transposed,
  turn,
} from "../../web/review/math.js";

const HALF = Math.SQRT1_2;
const QUARTER_TURN = [0, 0, HALF, HALF]; // 90 degrees about z

const near = (found, expected) => {
  assert.equal(found.length, expected.length);
  found.forEach((x, k) => assert.ok(Math.abs(x - expected[k]) < 1e-12, `${found} != ${expected}`));
};

test("a quarter turn about z carries x to y", () => {
  near(turn(rotationOf(QUARTER_TURN), [1, 0, 0]), [0, 1, 0]);
});

test("a quaternion need not be of unit length", () => {
  near(rotationOf(QUARTER_TURN.map((x) => 3 * x)), rotationOf(QUARTER_TURN));
});

test("a rotation times its transpose is the identity", () => {
  const R = rotationOf([0.1, -0.4, 0.2, 0.8]);
  near(times(R, transposed(R)), [1, 0, 0, 0, 1, 0, 0, 0, 1]);
});

test("a pose rotates first and then translates", () => {
  near(apply([10, 20, 30, ...QUARTER_TURN], [1, 2, 3]), [8, 21, 33]);
});

test("nudging turns about the pose's own place", () => {
  const pose = nudged([5, 6, 7, 0, 0, 0, 1], [1, 0, 0], [0, 0, 1], Math.PI / 2);
  near(pose, [6, 6, 7, ...QUARTER_TURN]);
});

test("nudging without an axis only moves", () => {
  near(nudged(IDENTITY, [0, 0, 2], [0, 0, 0], 0), [0, 0, 2, 0, 0, 0, 1]);
});

test("two poses lie apart by a distance and an angle, whatever the quaternion's sign", () => {
  const [m, deg] = apart([0, 0, 0, 0, 0, 0, 1], [3, 4, 0, ...QUARTER_TURN.map((x) => -x)]);
  assert.equal(m, 5);
  assert.ok(Math.abs(deg - 90) < 1e-9);
});

test("from above x points right and y up", () => {
  const camera = new Camera();
  camera.scale = 10;
  near(camera.toScreen([1, 2, 3], 100, 60), [60, 10]);
});

test("panning keeps the point under the pointer", () => {
  const camera = new Camera();
  Object.assign(camera, { yaw: 0.7, pitch: 0.4, scale: 25, center: [1, -2, 0.5] });
  const p = [0.3, 0.9, -0.4];
  const [x, y] = camera.toScreen(p, 800, 600);
  camera.pan(13, -7);
  near(camera.toScreen(p, 800, 600), [x + 13, y - 7]);
});
