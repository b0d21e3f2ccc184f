import "./english.js?live";

import assert from "node:assert/strict";
import { test } from "node:test";

import { axisRows, next, steps } from "../../web/live/dance_captions.js";

const axes = (shown) => [
  ...["x", "y", "z"].map((axis) => ({ quantity: "rotation", axis, shown })),
  ...["x", "y", "z"].map((axis) => ({ quantity: "position", axis, shown: 1 })),
  { quantity: "clock", axis: "", shown: 1 },
];
const MOTION = { still_s: 4, tilt_deg: [40, 30], turned_deg: [400, 380], axes: axes(1) };
const LOOP = { walked_m: 20, start_m: 1 };

test("the next step is the first one that is not done", () => {
  assert.match(next(undefined, undefined), /Stand still/);
  assert.match(next({ ...MOTION, still_s: 1 }, LOOP), /Stand still for 3 s/);
  assert.match(next({ ...MOTION, tilt_deg: [40, 10] }, LOOP), /Bend forward/);
  assert.match(next({ ...MOTION, turned_deg: [400, 90] }, LOOP), /Turn around/);
  assert.match(next(MOTION, { walked_m: 20, start_m: 9 }), /come back/);
  assert.match(next(MOTION, LOOP), /Every axis is observed/);
});

test("after the steps it says that axes are missing", () => {
  const weak = { ...MOTION, axes: axes(0.4) };
  assert.match(next(weak, LOOP), /Bend and turn again/);
  assert.deepEqual(axisRows(weak)[0], ["rotation", "40 %", "40 %", "40 %"]);
});

test("an axis is observed only when it is shown completely", () => {
  const rows = axisRows({ axes: axes(0.999) });
  assert.deepEqual(rows[0].slice(1), ["99 %", "99 %", "99 %"]);
  assert.deepEqual(rows[2], ["clock", "✓ observed"]);
});

test("without any message nothing is done", () => {
  assert.deepEqual(
    steps(undefined, undefined).map(({ done }) => done),
    [false, false, false, false],
  );
  assert.deepEqual(axisRows(undefined), []);
});
