import assert from "node:assert/strict";
import { test } from "node:test";

import { ENLARGED, ellipseMarks, knownPlaces } from "../../web/slices/ellipses.js";
import { parse } from "../../web/slices/state.js";

const NORTH_EAST = { major_m: 0.02, minor_m: 0.01, azimuth_deg: 45, up_m: 0.03 };
const place = (/** @type {number[]} */ at) => ({ id: "P1", at, map: NORTH_EAST, survey: null });
const reach = (/** @type {number[][]} */ points, /** @type {number[]} */ along) =>
  Math.max(...points.map((p) => p[0] * along[0] + p[1] * along[1])) / ENLARGED;
const near = (/** @type {number} */ a, /** @type {number} */ b) =>
  assert.ok(Math.abs(a - b) < 2e-4, `${a} is not ${b}`);

test("an ellipse lies in a horizontal slice at its azimuth", () => {
  const state = { ...parse("?kind=horizontal"), kind: "horizontal", z: 1 };
  const [{ points }, dot] = ellipseMarks(state, [place([0, 0, 1.2])]);
  const s = Math.SQRT1_2;
  near(reach(points, [s, s]), 0.02);
  near(reach(points, [-s, s]), 0.01);
  assert.equal(dot.text, "P1");
});

test("in a vertical slice it has the height of its deviation", () => {
  const state = { ...parse(""), kind: "vertical", a: [0, 0], b: [10, 0] };
  const [{ points }] = ellipseMarks(state, [place([0, 0, 0])]);
  near(reach(points, [0, 1]), 0.03);
  near(reach(points, [1, 0]), Math.sqrt((0.02 ** 2 + 0.01 ** 2) / 2));
});

test("points away from the slice, and points that were not measured, are left out", () => {
  const state = { ...parse(""), kind: "horizontal", z: 1 };
  assert.deepEqual(ellipseMarks(state, [place([0, 0, 9])]), []);
  const rows = [
    { id: "P1", stated: NORTH_EAST, survey: null },
    { id: "P2", stated: null },
  ];
  assert.deepEqual(
    knownPlaces({ P1: [1, 2, 3] }, rows).map((one) => one.id),
    ["P1"],
  );
});
