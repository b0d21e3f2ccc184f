import "./english.js";

import assert from "node:assert/strict";
import { test } from "node:test";

import { figures, headline } from "../../web/shared/figures.js";

const NOTE = { date: "2026-11-12", method: "joint", sd_deg: 0.02, sd_mm: 1.1, sd_ms: 0 };
const RIG = {
  name: "our backpack",
  sensors: [
    { name: "horizontal", model: "VLP-16", serial: "AF17" },
    { name: "vertical", model: "VLP-16", serial: "" },
  ],
  calibration: NOTE,
  age_days: 10,
  max_age_days: 365,
};
const of = (rig_origin) => new Map(figures({ rig_origin }));

test("an approval quotes serial numbers, date and accuracy of the rig", () => {
  const rows = of(RIG);
  assert.equal(rows.get("Rig"), "our backpack");
  assert.equal(rows.get("Serial numbers"), "horizontal AF17, vertical not known");
  assert.equal(
    rows.get("Rig calibrated"),
    "2026-11-12 by joint, 10 days before the walk; σ 0.02°, 1.1 mm",
  );
});

test("an old calibration says so, and one without a date nothing of its age", () => {
  assert.match(of({ ...RIG, max_age_days: 9 }).get("Rig calibrated"), /10 days .* \(old\)/);
  assert.equal(
    of({ ...RIG, age_days: null }).get("Rig calibrated"),
    "2026-11-12 by joint; σ 0.02°, 1.1 mm",
  );
  assert.match(of({ ...RIG, calibration: null }).get("Rig calibrated"), /not known/);
});

test("a map of an earlier version says nothing of its rig", () => {
  assert.deepEqual(figures({ points: undefined }), []);
});

test("a 2-D map has no number of points on its card", () => {
  assert.deepEqual(headline({ path_length_m: 12, points: 0 }), ["12 m path", "2-D map"]);
  assert.deepEqual(headline({ path_length_m: 12 }), ["12 m path", "2-D map"]);
  assert.deepEqual(headline({ path_length_m: 12, points: 9 }), ["12 m path", "9 points"]);
});
