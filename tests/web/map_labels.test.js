// Texts over the map do not cover each other.

import assert from "node:assert/strict";
import { test } from "node:test";

import { apart } from "../../web/map/labels.js";

const label = (x, y, words = "Distance 1  4.315 m") => ({ x, y, words });

test("labels of the same place are one below the other", () => {
  const ys = apart([label(50, 100), label(50, 100), label(60, 104)]).map(({ y }) => y);

  assert.deepEqual(ys, [100, 116, 132]);
});

test("labels beside each other stay", () => {
  const given = [label(50, 100, "A 1"), label(120, 100, "B 2"), label(50, 117, "C 3")];

  assert.deepEqual(apart(given), given);
});
