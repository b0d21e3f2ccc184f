import "./english.js";

import assert from "node:assert/strict";
import { test } from "node:test";

import { Camera, moveByPointer } from "../../web/live/camera.js";

const MIDDLE = [150, 100];

/** A map on the screen whose pointers a test moves. */
class FakeMap extends EventTarget {
  setPointerCapture() {}
  getBoundingClientRect() {
    return { left: 20, top: 30 };
  }
  point(type, pointerId, [x, y], more = {}) {
    const event = new Event(type, { cancelable: true });
    this.dispatchEvent(
      Object.assign(event, { pointerId, clientX: x + 20, clientY: y + 30, ...more }),
    );
  }
}

function touched({ following = false } = {}) {
  const camera = new Camera();
  const map = new FakeMap();
  const moves = [];
  moveByPointer(map, camera, {
    onMove: () => moves.push("move"),
    onPan: () => moves.push("pan"),
    following: () => following,
    middle: () => MIDDLE,
  });
  return { camera, map, moves };
}

/** Where a point of the map appears, in pixels of the element. */
const seen = (camera, place) => camera.project(place).map((x, k) => x + MIDDLE[k]);
const near = (actual, expected) =>
  actual.forEach((x, k) => assert.ok(Math.abs(x - expected[k]) < 1e-6, `${actual} ${expected}`));

/** The point of the ground at a pixel of the element, seen from above. */
function under(camera, [x, y]) {
  const [dx, dy] = [(x - MIDDLE[0]) / camera.pxPerM, (MIDDLE[1] - y) / camera.pxPerM];
  const [c, s] = [Math.cos(camera.yaw), Math.sin(camera.yaw)];
  return [camera.target[0] + c * dx - s * dy, camera.target[1] + s * dx + c * dy, 0];
}

test("one finger moves the map with it", () => {
  const { camera, map, moves } = touched();
  const place = under(camera, [60, 60]);
  map.point("pointerdown", 1, [60, 60]);
  map.point("pointermove", 1, [90, 50]);
  near(seen(camera, place), [90, 50]);
  assert.deepEqual(moves, ["pan", "move"]);
  map.point("pointerup", 1, [90, 50]);
  map.point("pointermove", 1, [10, 10]);
  near(seen(camera, place), [90, 50]);
});

test("two fingers zoom and rotate the map about their middle, which stays between them", () => {
  const { camera, map } = touched();
  const place = under(camera, [100, 80]);
  map.point("pointerdown", 1, [80, 80]);
  map.point("pointerdown", 2, [120, 80]);
  map.point("pointermove", 1, [100, 40]);
  map.point("pointermove", 2, [100, 120]);
  assert.ok(Math.abs(camera.pxPerM - 48) < 1e-9, `${camera.pxPerM}`);
  assert.ok(Math.abs(camera.yaw - Math.PI / 2) < 1e-9, `${camera.yaw}`);
  near(seen(camera, place), [100, 80]);
});

test("while the map follows, fingers zoom about the position of the user", () => {
  const { camera, map } = touched({ following: true });
  map.point("pointerdown", 1, [20, 20]);
  map.point("pointerdown", 2, [60, 20]);
  map.point("pointermove", 2, [100, 20]);
  assert.deepEqual(camera.target, [0, 0, 0]);
  assert.equal(camera.pxPerM, 48);
});

test("in 3-D one finger orbits, with Shift it moves the map", () => {
  const { camera, map, moves } = touched();
  camera.tilt();
  map.point("pointerdown", 1, [60, 60]);
  map.point("pointermove", 1, [70, 60]);
  assert.deepEqual(camera.target, [0, 0, 0]);
  assert.ok(camera.yaw !== 0);
  map.point("pointermove", 1, [80, 60], { shiftKey: true });
  assert.notDeepEqual(camera.target, [0, 0, 0]);
  assert.deepEqual(moves, ["move", "pan", "move"]);
});

test("the wheel zooms about the mouse", () => {
  const { camera, map } = touched();
  const place = under(camera, [30, 40]);
  map.point("wheel", 0, [30, 40], { deltaY: -100 });
  assert.ok(camera.pxPerM > 24);
  near(seen(camera, place), [30, 40]);
});
