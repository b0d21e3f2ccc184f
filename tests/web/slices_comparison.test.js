import "./english.js";

// Bars of the histogram and frames of picked points; run by .ci/web.

import "./english.js?slices&pair";

import assert from "node:assert/strict";
import test from "node:test";
import { bars } from "../../web/slices/bars.js";
import { inFrames, poseInMap, unpacked } from "../../web/slices/align_math.js";

test("the highest class has the full height", () => {
  assert.deepEqual(bars([0, 2, 4]), [
    [0, 100, 1, 0],
    [1, 50, 1, 50],
    [2, 0, 1, 100],
  ]);
  assert.deepEqual(bars([0]), [[0, 100, 1, 0]]);
});

test("picked points are given in the frames of map and reference", () => {
  const points = { middle_map: [8, 5, 1], middle_reference: [100, 0, 0] };

  const found = inFrames({ p_i: [[1, 0, 0]], p_j: [[0, 2, 0]] }, points);

  assert.deepEqual(found, { p_map: [[9, 5, 1]], p_reference: [[100, 2, 0]] });
});

test("a pose between the middles becomes one between the frames", () => {
  const points = { middle_map: [8, 5, 1], middle_reference: [10, 0, 0] };
  const quarter = [0, 0, Math.SQRT1_2, Math.SQRT1_2];

  const pose = poseInMap([1, 0, 0, ...quarter], points);

  // the middle of the reference, 10 0 0, lies at 1 0 0 beside the middle of the map
  [9, -5, 1].forEach((x, k) => assert.ok(Math.abs(pose[k] - x) < 1e-9));
  assert.deepEqual(pose.slice(3), quarter);
});

test("points arrive as little-endian floats", () => {
  const bytes = Buffer.from(new Float32Array([1, -2, 3.5]).buffer);

  assert.deepEqual([...unpacked(bytes.toString("base64"))], [1, -2, 3.5]);
});
