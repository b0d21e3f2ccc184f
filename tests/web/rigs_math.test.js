import "./english.js?rigs";

import assert from "node:assert/strict";
import { test } from "node:test";

import { OrbitCamera } from "../../web/rigs/orbit_camera.js";
import { changesOf, matrixOf, placed, rotationBetween, short } from "../../web/rigs/rig_math.js";
import { boundsOf, describe, shapesOf } from "../../web/rigs/rig_scene.js";

const near = (actual, expected, what = "") =>
  actual.forEach((value, k) =>
    assert.ok(Math.abs(value - expected[k]) < 1e-6, `${what} ${actual} ${expected}`),
  );

const sensor = (more = {}) => ({
  name: "top",
  kind: "lidar",
  model: "VLP-16",
  xyz_m: [0, 0, 0.3],
  rpy_deg: [0, 0, 0],
  time_offset_s: 0,
  address: "",
  port: 2368,
  topic: "",
  head_topic: "",
  head_rate_deg_s: 0,
  enabled: true,
  ...more,
});
const rig = (sensors = [sensor()], more = {}) => ({
  name: "rig",
  sensors,
  imu: { xyz_m: [0, 0, 0], rpy_deg: [0, 0, 0], time_offset_s: 0, port: 8309 },
  gnss: { lever_arm_m: [0, 0, 0], time_offset_s: 0, port: 8310, serial: "" },
  ...more,
});

test("a mount turns by roll, then pitch, then yaw", () => {
  near(placed(matrixOf([0, 90, 0]), [1, 2, 3], [0, 0, 1]), [2, 2, 3], "spin axis forward");
  near(placed(matrixOf([90, 0, 90]), [0, 0, 0], [0, 1, 0]), [0, 0, 1]);
  near(placed(matrixOf([90, 0, 90]), [0, 0, 0], [1, 0, 0]), [0, 1, 0]);
});

test("the rotation between two mounts is about the axes of the body", () => {
  near(rotationBetween([0, 90, 0], [0, 91.36, 0]), [0, 1.36, 0]);
  near(rotationBetween([0, 90, 0], [2, 90, 0]), [0, 0, -2], "roll at 90° of pitch");
  near(rotationBetween([10, 20, 30], [10, 20, 30]), [0, 0, 0]);
  near(rotationBetween([0, 0, 0], [0, 0, 180]).map(Math.abs), [0, 0, 180]);
});

test("two versions differ in what was changed and in nothing else", () => {
  const before = rig([sensor(), sensor({ name: "back", rpy_deg: [0, 90, 0] })]);
  const after = rig([
    sensor({ xyz_m: [0.01, 0, 0.3], time_offset_s: 0.005, enabled: false }),
    sensor({ name: "side" }),
  ]);

  assert.deepEqual(changesOf(before, before), []);
  assert.deepEqual(changesOf(before, after), [
    "top: position x +1.00 cm",
    "top: clock +5.000 ms",
    "top: disabled",
    "side: added",
    "back: removed",
  ]);
  const moved = rig([sensor({ rpy_deg: [0, -1.5, 0], port: 2369 })], {
    gnss: { lever_arm_m: [0, 0, 0.5], time_offset_s: 0, port: 8310, serial: "" },
  });
  assert.deepEqual(changesOf(rig(), moved), [
    "top: rotation about y −1.500°",
    "top: port 2368 → 2369",
    "GNSS antenna: lever arm z +50.00 cm",
  ]);
});

test("numbers are short and without a negative zero", () => {
  assert.deepEqual(
    [short(12.5, 2), short(-0.001, 2), short(90, 3), short(1.23456, 3)],
    ["12.5", "0", "90", "1.235"],
  );
});

test("the field of view of an upright sensor lies between its beams", () => {
  const shapes = shapesOf(rig(), { "VLP-16": [-15, 15] });
  const rings = shapes.filter((one) => one.role === "sensor-0" && one.kind === "line");

  const heights = rings.map((ring) => ring.points[0][2] - 0.3);
  near(heights, [-0.42 * Math.sin(Math.PI / 12), 0.42 * Math.sin(Math.PI / 12)]);
  assert.ok(rings.every((ring) => !ring.dashed));
});

test("a sensor of unknown beams, a profiler and an antenna are drawn", () => {
  const unknown = shapesOf(rig([sensor({ model: "generic" })]), { generic: null });
  const profiler = shapesOf(rig([sensor({ model: "generic", kind: "profiler" })]), {});
  const dashed = (shapes) => shapes.find((one) => one.dashed && one.role === "sensor-0").points;

  assert.ok(dashed(unknown).every(([, , z]) => Math.abs(z - 0.3) < 1e-9));
  assert.ok(dashed(profiler).every(([, y]) => Math.abs(y) < 1e-9));
  const names = (shapes) => shapes.filter((one) => one.kind === "text").map((one) => one.text);
  assert.deepEqual(names(unknown), ["x", "y", "z", "top", "IMU"]);
  const gnss = { lever_arm_m: [0, 0, 0.45], time_offset_s: 0, port: 8310, serial: "" };
  assert.ok(names(shapesOf(rig([sensor()], { gnss }), {})).includes("GNSS antenna"));
});

test("the view fits the rig and orbits about its middle", () => {
  const bounds = boundsOf(rig([sensor({ xyz_m: [0, 0, 1] })]));
  const camera = new OrbitCamera();
  camera.reset(bounds, [400, 300]);

  near(bounds.middle, [0, 0, 0.5]);
  near(camera.project(bounds.middle), [0, 0, 0]);
  const [right, down] = camera.project([0, 0, 1]);
  assert.ok(Math.abs(right) < 1e-9 && down < 0 && down > -150);
  camera.orbit(0, 1e6); // from above: x points down, y to the right
  near(camera.project([0, 0, 1]).slice(0, 2), [0, 0]);
  camera.yaw = 0;
  const seen = camera.project([0, 0.1, 0.5]);
  assert.ok(seen[0] > 0 && Math.abs(seen[1]) < 1e-6);
  camera.yaw = Math.PI / 2; // from the left: what is in front is on the left
  assert.ok(camera.project([0.1, 0, 0.5])[0] < 0);
});

test("zooming has limits and the words name every sensor", () => {
  const camera = new OrbitCamera();
  camera.reset({ middle: [0, 0, 0], radius: 1 }, [200, 200]);
  const fitted = camera.pxPerM;
  camera.zoom(1e6);
  assert.equal(camera.pxPerM, 10 * fitted);
  camera.zoom(1e-9);
  assert.equal(camera.pxPerM, fitted / 4);
  assert.match(describe(rig()), /top, VLP-16, at 0, 0, 30 cm/);
});
