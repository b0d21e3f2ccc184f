import "./english.js?map";

import assert from "node:assert/strict";
import { test } from "node:test";

import { rayAt, toScreen } from "../../web/map/camera.js";
import { alongAxis, handlesOf, isDraggable, movedHandle } from "../../web/map/clip_handles.js";
import { planesOf } from "../../web/map/clip.js";

const SCREEN = { width: 800, height: 600 };
const CAMERA = { target: [4, 5, 1], yaw: 0.6, pitch: -0.7, distance: 12, parallel: false };
const BOX = { center: [4, 5, 1], size: [3, 2, 1], yaw: 0.4 };
const SECTION = { a: [1, 2], b: [5, 4], thickness: 0.5 };
const CLIP = { heights: [null, null], box: BOX, section: null };
const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-6, `${a} ${b}`);

test("each face of the box has a handle on it, and the section has one in its middle", () => {
  const handles = handlesOf({ ...CLIP, section: SECTION }, [0, 3]);
  assert.deepEqual(
    handles.map(({ key }) => key),
    ["+x", "-x", "+y", "-y", "+z", "-z", "section"],
  );
  for (const { p } of handles.slice(0, 6)) {
    const from = planesOf(CLIP).map(([a, b, c, d]) => a * p[0] + b * p[1] + c * p[2] + d);
    near(Math.min(...from), 0);
  }
  assert.deepEqual(handles[6].p, [3, 3, 1.5]);
});

for (const parallel of [false, true])
  test(`a handle follows the pointer along its axis, parallel ${parallel}`, () => {
    const camera = { ...CAMERA, parallel };
    for (const handle of handlesOf(CLIP, [0, 3])) {
      const goal = handle.p.map((x, k) => x + 0.7 * handle.axis[k]);
      const { x, y } = toScreen(camera, SCREEN, goal);
      near(alongAxis(handle, rayAt(camera, SCREEN, [x, y])), 0.7);
    }
  });

test("a moved face leaves the other faces where they are, and none passes its opposite", () => {
  for (const handle of handlesOf(CLIP, [0, 3])) {
    const moved = movedHandle(CLIP, handle, 0.5);
    const [before, after] = [CLIP, moved].map((clip) => handlesOf(clip, [0, 3]));
    const k = before.findIndex(({ key }) => key === handle.key);
    const opposite = k % 2 ? k - 1 : k + 1;
    after[opposite].p.forEach((x, axis) => near(x, before[opposite].p[axis]));
    after[k].p.forEach((x, axis) => near(x, handle.p[axis] + 0.5 * handle.axis[axis]));
    near(Math.min(...movedHandle(CLIP, handle, -9).box.size), 0.05);
  }
});

test("a section moves across itself", () => {
  const clip = { ...CLIP, box: null, section: SECTION };
  const [handle] = handlesOf(clip, [0, 3]);
  const { a, b } = movedHandle(clip, handle, 2).section;
  near((b[0] - a[0]) / (b[1] - a[1]), 2);
  near(Math.hypot(a[0] - 1, a[1] - 2), 2);
  near((a[0] - 1) * 4 + (a[1] - 2) * 2, 0);
});

test("what moves toward the eye cannot be dragged", () => {
  const top = { ...CAMERA, pitch: -Math.PI / 2, parallel: true };
  const able = handlesOf(CLIP, [0, 3]).filter((handle) => isDraggable(top, handle));
  assert.deepEqual(
    able.map(({ key }) => key),
    ["+x", "-x", "+y", "-y"],
  );
});
