import "./english.js?map";

import assert from "node:assert/strict";
import { test } from "node:test";

const address = { search: "", pathname: "/projects/office/map/" };
Object.assign(globalThis, { location: address, innerWidth: 1000 });
const { liftBrush, paint, paintedVolume } = await import("../../web/map/brush.js");
const { page } = await import("../../web/map/page.js");
const { brushVolume, noBrush, painted } = await import("../../web/slices/brush.js");
const { parse } = await import("../../web/slices/state.js");

/** A wall 1 m away left of pixel 100, another 3 m away right of it, nothing above pixel 200. */
const under = ([x, y]) => (y > 200 ? null : [x / 100, y / 100, x < 100 ? 1 : 3]);
const stage = { under, draw: () => {} };

test("a fast drag of the brush leaves no gap, and paints nothing between two walls", () => {
  page.brush = { radius: 0.1, strokes: [] };

  paint([0, 0], [200, 0], { ...stage, done: false });
  paint([0, 0], [200, 0], { ...stage, done: true });

  const { path_m } = paintedVolume();
  for (const z of [1, 3]) {
    const x = path_m.filter((p) => p[2] === z).map((p) => p[0]);
    assert.ok(x.length > 7);
    assert.ok(x.every((value, k) => k === 0 || value - x[k - 1] <= 0.2));
  }
  assert.deepEqual([...new Set(path_m.map((p) => p[2]))], [1, 3]);
});

test("what misses the map paints nothing", () => {
  page.brush = { radius: 0.1, strokes: [] };

  paint([10, 250], [90, 250], { ...stage, done: true });

  assert.equal(paintedVolume(), null);
});

test("a stroke on a slice has its normal and its thickness", () => {
  const state = parse("?kind=vertical&a=1,2&b=1,7&t=0.2");
  const once = painted(noBrush(), [0.5, 1], [0.9, 1]);

  const volume = brushVolume(state, painted(once, [0.9, 1], [0.9, 1.01]));

  assert.equal(volume.thick_m, 0.2);
  assert.deepEqual(volume.across.map(Math.abs), [1, 0, 0]);
  assert.deepEqual(
    [volume.path_m[0], volume.path_m.at(-1)],
    [
      [1, 2.5, 1],
      [1, 2.9, 1],
    ],
  );
  assert.ok(volume.path_m.length >= 5);
});

test("a second finger undoes the stroke that the first one began, and no other", () => {
  page.brush = { radius: 0.1, strokes: [] };
  const stage = { under: ([x, y]) => [x, y, 0], draw() {} };
  paint([0, 0], [1, 0], { ...stage, done: true });
  liftBrush();
  paint([0, 5], [0.5, 5], { ...stage, done: false });
  liftBrush();

  assert.deepEqual(
    page.brush.strokes.map(([first]) => first),
    [[0, 0, 0]],
  );
});
