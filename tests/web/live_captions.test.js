import "./english.js?live";

import assert from "node:assert/strict";
import { test } from "node:test";

import { lidarRow } from "../../web/live/captions.js";

test("each sensor has its own jumps of the clock", () => {
  const lidar = { name: "front", per_s: 754, lost: 0, clock: "in step", jumps: 0 };
  const clocks = [0, 1, 3].map(
    (jumps) => lidarRow({ ...lidar, jumps, clock: jumps ? "jumped" : "in step" })[3],
  );

  assert.deepEqual(clocks, ["in step", "jumped", "jumped 3 times"]);
});
