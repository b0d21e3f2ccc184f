import "./english.js?projects";

import assert from "node:assert/strict";
import { test } from "node:test";

import { beamRows, calibratingJob, outcomeOf, rowsOf } from "../../web/projects/rig_audit.js";
import { slug } from "../../web/rigs/rig_math.js";

const parameter = (more = {}) => ({
  sensor: "vertical",
  quantity: "rotation",
  axis: "y",
  unit: "rad",
  change: 0.0237,
  sd: 0.00035,
  status: "off",
  ...more,
});

test("a row has the change with its standard deviation, and the result in a word", () => {
  assert.deepEqual(rowsOf([parameter()]), [
    {
      sensor: "vertical",
      quantity: "rotation y",
      change: "+1.358 ± 0.020°",
      mark: "✕",
      word: "differs",
      className: "bad",
    },
  ]);
  const clock = { quantity: "clock", axis: "", unit: "s", change: -0.005, sd: 0.0001 };
  assert.equal(rowsOf([parameter(clock)])[0].change, "−5.00 ± 0.10 ms");
  const unknown = { sensor: "imu", unit: "m", change: 0, sd: null, status: "not observable" };
  const [row] = rowsOf([parameter(unknown)]);
  assert.deepEqual([row.sensor, row.change, row.word], ["IMU", "–", "not observable"]);
});

test("the outcome is that of the worst parameter, unless the calibrated rig is used", () => {
  const word = (parameters, applied = false) => outcomeOf({ parameters, applied }).word;

  assert.match(word([parameter(), parameter({ status: "consistent" })]), /differs/);
  assert.match(word([parameter({ status: "consistent" })]), /agrees/);
  assert.match(word([parameter()], true), /Calibrated/);
  assert.match(word([]), /Not compared/);
});

test("the job is repeated with calibration, once", () => {
  const inputs = {
    recordings: ["/data/walk.pcap"],
    preset: "outdoor",
    rig: "/srv/rigs/a/1/a-v1.toml",
    imu: "",
    gnss: "/data/gnss.csv",
    settings: ["map.voxel_m=0.02", "calibration.mode=off"],
    remake: false,
  };
  const views = [{ job: { inputs: { recordings: [] } } }, { job: { inputs } }];

  assert.deepEqual(calibratingJob("walk", views), {
    project: "walk",
    recordings: ["/data/walk.pcap"],
    preset: "outdoor",
    rig: "/srv/rigs/a/1/a-v1.toml",
    imu: "",
    gnss: "/data/gnss.csv",
    settings: ["map.voxel_m=0.02", "calibration.mode=auto"],
  });
  assert.equal(calibratingJob("walk", views.slice(0, 1)), null);
});

test("an exported file is imported under the name of its rig", () => {
  assert.equal(slug("field-v12.toml"), "field");
  assert.equal(slug("Our backpack (2).toml"), "Our-backpack-2-");
});

test("a beam is a row, and what the walk does not show says so", () => {
  const beam = (quantity, change, sd, status = "off") => ({
    sensor: "vertical",
    axis: "3",
    quantity: `beam ${quantity}`,
    change,
    sd,
    status,
  });
  const rows = beamRows([
    beam("range", 0.0035, 0.0002),
    beam("elevation", 0, null, "not observable"),
    beam("azimuth", -0.0005, 0.00005),
  ]);
  assert.deepEqual(rows, [
    ["vertical 3", "+3.50 ± 0.20 mm", "not observable", "−0.0286 ± 0.0029°"],
  ]);
});

test("the receiver has a name", () => {
  const [row] = rowsOf([
    {
      sensor: "gnss",
      quantity: "clock",
      axis: "",
      unit: "s",
      change: -0.05,
      sd: 0.0001,
      status: "off",
    },
  ]);
  assert.equal(row.sensor, "GNSS antenna");
});
