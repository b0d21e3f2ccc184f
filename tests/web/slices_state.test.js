import "./english.js?slices";

import assert from "node:assert/strict";
import { test } from "node:test";

import { roundStep, scaleBar } from "../../web/shared/scale_bar.js";
import {
  anglesOf,
  planeOf,
  distanceFrom,
  format,
  imageSize,
  moved,
  normalFrom,
  normalOf,
  parse,
  withoutPlane,
} from "../../web/slices/state.js";
import { endsOf, stretchMarks, timesOf } from "../../web/slices/stretch_mark.js";
import { sliceOf } from "../../web/shared/verdict.js";

test("an image has the pixels of the screen, but no more than the server draws", () => {
  assert.deepEqual(imageSize(800, 600, 1), { width: 800, height: 600 });
  assert.deepEqual(imageSize(800, 600, 3), { width: 1600, height: 1200 });
  assert.deepEqual(imageSize(5000, 1250, 1), { width: 4096, height: 1024 });
  assert.deepEqual(imageSize(2560, 1280, 2), { width: 4096, height: 2048 });
  assert.deepEqual(imageSize(0, 4, 1), { width: 16, height: 16 });
});

test("an empty address is the usual horizontal cut", () => {
  const state = parse("");
  assert.equal(state.given, false);
  assert.deepEqual(planeOf(state), { kind: "horizontal", z_m: 1.5, thickness_m: 0.1 });
});

for (const query of [
  "kind=horizontal&z=2.25&t=0.05&color=intensity",
  "kind=vertical&a=1,2&b=4,6&lo=-0.5&hi=3",
  "kind=free&o=1,2,3&n=0,1,1&u=0.5&v=-0.25&m=0.012",
]) {
  test(`the address comes back: ${query}`, () => {
    assert.deepEqual(parse(format(parse(query))), parse(query));
    assert.deepEqual(new Set(format(parse(query)).split("&")), new Set(query.split("&")));
  });
}

for (const [query, key, usual] of [
  ["kind=diagonal", "kind", "horizontal"],
  ["color=rainbow", "color", "height"],
  ["z=high", "z", 1.5],
  ["z=Infinity", "z", 1.5],
  ["t=-1", "t", 0.1],
  ["kind=vertical&a=1,2,3", "a", [0, 0]],
  ["kind=vertical&a=1,", "a", [0, 0]],
]) {
  test(`what makes no sense keeps its usual value: ${query}`, () => {
    assert.deepEqual(parse(query)[key], usual);
  });
}

test("a vertical cut looks along its unit normal", () => {
  const state = parse("kind=vertical&a=0,0&b=3,4");
  assert.deepEqual(normalOf(state), [0.8, -0.6, 0]);
});

test("moving a cut along its normal moves it by that distance", () => {
  for (const query of [
    "kind=horizontal&z=1",
    "kind=vertical&a=0,1&b=2,5",
    "kind=free&o=1,1,1&n=1,2,2",
  ]) {
    const state = parse(query);
    const point = { horizontal: [0, 0, 1], vertical: [0, 1, 0], free: [1, 1, 1] }[state.kind];
    assert.ok(Math.abs(distanceFrom(moved(state, 0.75), point) - 0.75) < 1e-12, query);
  }
});

test("a double wall is as far from a cut as its middle is along the normal", () => {
  const far = (/** @type {string} */ query) => distanceFrom(parse(query), [3, 5, 2]);
  assert.equal(far("kind=horizontal&z=1.5"), 0.5);
  assert.equal(far("kind=vertical&a=0,1&b=4,1"), 4);
  assert.equal(far("kind=free&o=1,2,3&n=2,0,0"), 2);
});

test("steps of a scale are 1, 2 or 5 times a power of ten", () => {
  assert.deepEqual([0.03, 0.2, 0.21, 7, 12].map(roundStep), [0.05, 0.2, 0.5, 10, 20]);
});

test("a normal and its angles are the same thing", () => {
  const n = normalFrom({ azimuth: 120, tilt: 35 });
  assert.deepEqual(anglesOf(n), { azimuth: 120, tilt: 35 });
});

test("a scale bar has a round length and its caption", () => {
  assert.deepEqual(scaleBar(40), { meters: 2, px: 80, text: "2 m" });
  assert.deepEqual(scaleBar(200), { meters: 0.5, px: 100, text: "50 cm" });
});

test("the slice at a finding is at its height, in the middle of its stretch, and marks it", () => {
  const place_m = /** @type {any} */ ([
    [1, 2, 1.2],
    [31, 2, 1.4],
  ]);
  const state = parse(sliceOf({ place_m, span_s: [40, 44.5] }));

  assert.deepEqual(planeOf(state), { kind: "horizontal", z_m: 1.3, thickness_m: 0.1 });
  assert.deepEqual([state.u, state.v, state.m], [16, 2, 0.09]);
  assert.deepEqual([endsOf(state.mark), timesOf(state.span)], [place_m, [40, 44.5]]);
  const again = parse(format(state));
  assert.deepEqual([again.mark, again.span], [state.mark, state.span]);
  assert.deepEqual(parse(sliceOf({ place_m })).span, "");
});

test("a mark that is none of ours marks nothing", () => {
  assert.deepEqual(["", "1,2,x", "1,2,3", "1,2,3,4,5,6,7"].map(endsOf), [[], [], [], []]);
  assert.deepEqual(["", "4", "4,", "4,x", "1,2,3"].map(timesOf), [null, null, null, null, null]);
});

test("the walk is marked in any slice, where it is near", () => {
  const walk = [
    [0, 0, 1],
    [1, 0, 1],
    [5, 0, 1],
    [1, 1, 1],
  ];
  const level = { origin_m: [0, 0, 2], u: [1, 0, 0], v: [0, 1, 0] };
  const across = { origin_m: [0, 0, 0], u: [0, 1, 0], v: [0, 0, 1] };
  const points = (/** @type {any} */ plane) => stretchMarks(walk, plane).map((one) => one.points);

  assert.deepEqual(points(level), [walk.map((p) => p.slice(0, 2))]);
  assert.deepEqual(points({ ...level, origin_m: [0, 0, 4] }), []); // of another storey
  assert.deepEqual(points(across), [
    [
      [0, 1],
      [0, 1],
    ],
    [[1, 1]],
  ]);
  assert.deepEqual(stretchMarks(walk, /** @type {any} */ (level))[0]?.dots?.length, 2);
});

test("a map in other coordinates is shown by its own plane, in the same colors", () => {
  const before = "kind=vertical&a=1,2&b=3,4&u=5&v=6&m=0.02&color=intensity&t=0.02";
  const after = parse(`?${withoutPlane(before)}`);

  assert.equal(after.given, false);
  assert.deepEqual([after.kind, after.u, after.v, after.m], ["horizontal", null, null, null]);
  assert.deepEqual([after.color, after.t], ["intensity", 0.02]);
});
