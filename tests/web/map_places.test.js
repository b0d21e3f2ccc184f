import "./english.js?map";

import assert from "node:assert/strict";
import { test } from "node:test";

import { toScreen } from "../../web/map/camera.js";
import { cameraAt, clipAround, lineOf, pinAt, timesOf } from "../../web/map/places.js";
import { parse } from "../../web/map/state.js";

const SCREEN = { width: 800, height: 600 };
const CAMERA = { target: [4, 5, 1], yaw: 0.6, pitch: -0.7, distance: 12, parallel: false };
const FREE = { left: 400, right: 400, up: 300, down: 300 };
const PARALLEL = { ...CAMERA, parallel: true };
const WALK = {
  t_s: [0, 1, 3],
  positions_m: [
    [0, 0, 1],
    [2, 0, 1],
    [2, 8, 1],
  ],
};

test("a link marks a stretch, a place or nothing", () => {
  assert.deepEqual(parse("span=44,40").mark, { span: [40, 44], place: [] });
  assert.deepEqual(parse("place=1,2,3,4,5,6").mark, {
    span: null,
    place: [
      [1, 2, 3],
      [4, 5, 6],
    ],
  });
  for (const query of [
    "span=1",
    "span=1,NaN",
    "place=1,2,3",
    "span=<b>,2",
    "place=1e300,0,0,0,0,0",
  ])
    assert.equal(parse(query).mark, null, query);
});

test("a marked stretch is that part of the walk, without a walk its ends", () => {
  const place = [
    [9, 9, 9],
    [8, 8, 8],
  ];
  assert.deepEqual(lineOf({ span: [0.5, 2], place }, WALK).flat(), [1, 0, 1, 2, 0, 1, 2, 4, 1]);
  assert.deepEqual(lineOf({ span: [0.5, 2], place }, null), place);
  assert.deepEqual(lineOf({ span: null, place }, WALK), place);
  assert.equal(timesOf({ span: [0.5, 2], place }), "0.5 s to 2.0 s");
});

test("the camera that flies to a stretch shows all of it, from above", () => {
  const line = lineOf({ span: [0, 3], place: [] }, WALK);
  const camera = cameraAt(line, { ...CAMERA, pitch: 0 }, { screen: SCREEN, free: FREE });
  assert.ok(camera.pitch < -0.5);
  for (const p of line) {
    const { x, y } = toScreen(camera, SCREEN, p);
    assert.ok(x > 0 && x < 800 && y > 0 && y < 600, `${x} ${y}`);
  }
});

test("a place that a clip hides is shown: its storey, no box or section beside it", () => {
  const index = { storeys: [{ floor_m: 0 }, { floor_m: 3 }] };
  const heightsOf = ({ floor_m }) => [floor_m - 0.4, floor_m + 2.2];
  const box = { center: [50, 0, 0], size: [1, 1, 1], yaw: 0 };
  const around = { center: [1, 1, 1], size: [9, 9, 9], yaw: 0 };
  const clip = { heights: [2.6, 5.2], box, section: null };

  const found = clipAround(clip, [1, 1, 1], { index, heightsOf });
  assert.deepEqual(found, { heights: [-0.4, 2.2], box: null, section: null });
  assert.deepEqual(
    clipAround({ ...clip, box: around }, [1, 1, 1], { index, heightsOf }).box,
    around,
  );
  const above = clipAround(clip, [1, 1, 2.7], { index: { storeys: [] }, heightsOf });
  assert.deepEqual(above.heights, [2.6, 5.2]);
  const hidden = clipAround(clip, [1, 1, 1], { index: { storeys: [] }, heightsOf });
  assert.deepEqual(hidden.heights, [null, null]);
});

test("a click takes the pin nearest to the eye, and only near it", () => {
  const pins = [3, 2].map((z) => ({ p: [4, 5, z], kind: "note", name: String(z) }));
  const top = { ...PARALLEL, yaw: 0, pitch: -Math.PI / 2 };
  const view = { camera: top, screen: SCREEN };
  assert.equal(pinAt(pins.reverse(), [400, 293], view)?.name, "3");
  assert.equal(pinAt(pins, [440, 293], view), undefined);
});
