import assert from "node:assert/strict";
import test from "node:test";

import { exportQuery, exportedClip, planesOf } from "../../web/map/clip.js";

const MAP = { low_m: [-4, -6, -1], high_m: [16, 14, 5] };
const BOX = { center: [3, 2, 1], size: [6, 4, 3], yaw: 0.6 };
const SECTION = { a: [0, 1], b: [5, 4], thickness: 1.5 };

/** Points all over the map, its corners among them. */
const points = Array.from({ length: 21 * 21 * 13 }, (_, k) => [
  -4 + (k % 21),
  -6 + (Math.floor(k / 21) % 21),
  -1 + Math.floor(k / 441) / 2,
]);

const shown = (clip) => {
  const planes = planesOf(clip);
  return points.filter((p) =>
    planes.every(([a, b, c, d]) => a * p[0] + b * p[1] + c * p[2] + d >= 0),
  );
};

const exported = (boxes) =>
  points.filter((p) =>
    boxes.every(([x, y, z, dx, dy, dz, deg]) => {
      const [c, s] = [Math.cos((deg * Math.PI) / 180), Math.sin((deg * Math.PI) / 180)];
      const [u, v] = [p[0] - x, p[1] - y];
      const across = [c * u + s * v, c * v - s * u, p[2] - z].map(Math.abs);
      return [dx, dy, dz].every((edge, k) => across[k] <= edge / 2);
    }),
  );

for (const [name, clip, count] of [
  ["heights alone", { heights: [0.2, null], box: null, section: null }, 1],
  ["a turned box", { heights: [null, null], box: BOX, section: null }, 1],
  ["a box between heights", { heights: [0.3, 1.7], box: BOX, section: null }, 1],
  ["a section", { heights: [null, 2.2], box: null, section: SECTION }, 1],
  ["a section through a box", { heights: [null, null], box: BOX, section: SECTION }, 2],
])
  test(`an export of ${name} has the points that are shown`, () => {
    const boxes = exportedClip(clip, MAP);
    assert.equal(boxes.length, count);
    assert.deepEqual(exported(boxes), shown(clip));
    assert.ok(shown(clip).length > 10 && shown(clip).length < points.length);
  });

test("without a clip the form opens for all of the map", () => {
  const boxes = exportedClip({ heights: [null, null], box: null, section: null }, MAP);
  assert.deepEqual(boxes, []);
  assert.equal(exportQuery(boxes), "clip=");
  assert.equal(exportQuery([[1, 2, 3, 4, 5, 6, 1 / 3]]), "clip=1,2,3,4,5,6,0.33333");
});
