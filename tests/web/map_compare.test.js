import "./english.js?map&compare";

import assert from "node:assert/strict";
import { test } from "node:test";

import {
  ALONE,
  BELOW,
  OTHER,
  colorsOf,
  decoded,
  differenceColor,
  usualReach,
} from "../../web/map/compare_colors.js";
import { comparedIn, comparedQuery } from "../../web/map/compare_state.js";
import { format, parse } from "../../web/map/state.js";

const ID = "00ff00ff00ff00ff";

/** Core points as the server writes them: [x, y, z, distance and level in steps, state, normal]. */
function written(rows) {
  const view = new DataView(new ArrayBuffer(20 * rows.length));
  rows.forEach(([x, y, z, distance, lod, state, ...normal], k) => {
    [x, y, z].forEach((value, axis) => view.setFloat32(20 * k + 4 * axis, value, true));
    view.setInt16(20 * k + 12, distance, true);
    view.setUint16(20 * k + 14, lod, true);
    view.setUint8(20 * k + 16, state);
    normal.forEach((value, axis) => view.setInt8(20 * k + 17 + axis, value));
  });
  return view.buffer;
}

test("core points are read as the server writes them", () => {
  const data = written([
    [1.5, -2, 3, -250, 40, 1, 0, -127, 64],
    [4, 5, 6, 7, 8, 2, 127, 0, 0],
  ]);

  const points = decoded(data, 0.0002);

  assert.equal(points.count, 2);
  assert.deepEqual([...points.places], [1.5, -2, 3, 4, 5, 6]);
  assert.ok(Math.abs(points.distances[0] + 0.05) < 1e-6);
  assert.deepEqual([...points.states], [1, 2]);
  assert.deepEqual([...points.normals], [0, -127, 64, 127, 0, 0]);
});

test("only significant distances have a color of their own", () => {
  const points = { count: 5, distances: [0.05, 0.05, 0.05, 0, 0], states: [0, 1, 2, 3, 4] };

  const colors = colorsOf(points, 0.1);

  const of = (k) => [...colors.slice(3 * k, 3 * k + 3)];
  assert.deepEqual([of(0), of(2), of(3), of(4)], [BELOW, ALONE, OTHER, OTHER]);
  assert.deepEqual(of(1), differenceColor(0.05, 0.1));
});

test("colors differ by side and end at their ends", () => {
  const [behind, front] = [differenceColor(-0.03, 0.03), differenceColor(0.03, 0.03)];

  assert.ok(behind[2] > 2 * behind[0] && front[0] > 2 * front[2]); // blue and red
  assert.deepEqual(differenceColor(-7, 0.03), behind);
  assert.notDeepEqual(differenceColor(0.01, 0.03), differenceColor(0.02, 0.03));
});

test("the usual end of the colors is a round number above most distances", () => {
  assert.equal(usualReach({ p95_m: 0.0485, lod_p50_m: 0.0185 }), 0.05);
  assert.equal(usualReach({ p95_m: 0.001, lod_p50_m: 0.009 }), 0.02);
  assert.equal(usualReach(null), 0.005);
});

test("the comparison that is shown is in the address", () => {
  const query = `compare=${ID}&reach=12.5&swipe=0.25`;

  const state = parse(query);

  assert.deepEqual(state.compare, { id: ID, reach: 0.0125, swipe: 0.25 });
  assert.equal(format(state), query);
  assert.equal(format(parse(`compare=${ID}`)), `compare=${ID}`);
});

test("what an address cannot mean is not compared", () => {
  const of = (query) => comparedIn(new URLSearchParams(query));

  assert.equal(of("compare=../x").id, "");
  assert.deepEqual(of(`compare=${ID}&reach=-3&swipe=7`), { id: ID, reach: null, swipe: null });
  const written = new URLSearchParams();
  comparedQuery(of("reach=5"), written);
  assert.equal(written.toString(), "");
});
