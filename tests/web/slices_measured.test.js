import "./english.js";

// Measurements of a point in several directions are combined; run by .ci/web.

import "./english.js?slices";

import assert from "node:assert/strict";
import test from "node:test";
import { combined } from "../../web/slices/measured.js";

const [X, Y, Z] = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];
const near = (a, b) => a.forEach((x, k) => assert.ok(Math.abs(x - b[k]) < 1e-9, `${a} ${b}`));

test("a first measurement stays what it is", () => {
  assert.deepEqual(combined(null, { p: [1, 2, 3], along: [X] }), { p: [1, 2, 3], along: [X] });
});

test("a plan and a section together measure all three components", () => {
  const plan = { p: [1, 2, 3], along: [X, Y] };

  const both = combined(plan, { p: [1.5, 2.5, 3.5], along: [X, Z] });

  near(both.p, [1.5, 2, 3.5]);
  assert.equal(both.along.length, 3);
});

test("the same directions replace the earlier measurement", () => {
  const again = combined({ p: [1, 2, 3], along: [X, Y] }, { p: [4, 5, 6], along: [Y, X] });

  near(again.p, [4, 5, 6]);
  assert.equal(again.along.length, 2);
});

test("a surface askew corrects across itself only", () => {
  const n = [Math.SQRT1_2, Math.SQRT1_2, 0];

  const found = combined({ p: [0, 0, 1], along: [X, Y, Z] }, { p: [1, 0, 9], along: [n] });

  near(found.p, [0.5, 0.5, 1]);
  assert.equal(found.along.length, 3);
});

test("directions that nearly agree count once", () => {
  const nearly = [1, 0.001, 0];

  assert.equal(
    combined({ p: [0, 0, 0], along: [X] }, { p: [0, 0, 0], along: [nearly] }).along.length,
    1,
  );
});
