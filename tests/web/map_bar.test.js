import assert from "node:assert/strict";
import { test } from "node:test";

import { fitting } from "../../web/map/bar_fit.js";

const row = (/** @type {Array<[number, number]>} */ ...buttons) =>
  buttons.map(([bar, rank]) => ({ bar, rank, width: 50 }));
const room = (/** @type {number} */ width) => ({ width, gap: 10, more: 30 });

test("a row with room keeps all of its buttons in sight", () => {
  assert.deepEqual(fitting(row([0, 9], [0, 0], [1, 1]), room(160)), [true, true, true]);
});

test("what is used least goes first, and the button of its list takes room of its own", () => {
  const buttons = row([0, 1], [0, 9], [0, 8], [0, 2]);
  assert.deepEqual(fitting(buttons, room(180)), [true, false, true, true]);
  assert.deepEqual(fitting(buttons, room(179)), [true, false, false, true]);
});

test("each bar that lacks a button has a list", () => {
  const buttons = row([0, 0], [0, 9], [1, 0], [1, 8]);
  assert.deepEqual(fitting(buttons, room(190)), [true, false, true, true]);
  assert.deepEqual(fitting(buttons, room(170)), [true, false, true, false]);
});

test("what never leaves stays, however little room there is", () => {
  assert.deepEqual(fitting(row([0, 0], [0, 3]), room(10)), [true, false]);
});
