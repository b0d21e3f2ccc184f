import "./english.js";

import assert from "node:assert/strict";
import { test } from "node:test";

import {
  bytes,
  count,
  runProgressText,
  progressText,
  seconds,
  stateOf,
} from "../../web/shared/format.js";

const NARROW = "\u202f";

test("thousands are set apart", () => {
  assert.deepEqual([0, 999, 1000, 13512477].map(count), [
    "0",
    "999",
    `1${NARROW}000`,
    `13${NARROW}512${NARROW}477`,
  ]);
});

test("bytes have a unit that keeps the number short", () => {
  assert.deepEqual([0, 999, 1000, 12_345, 9_960_000, 2e15].map(bytes), [
    "0 B",
    "999 B",
    "1.0 kB",
    "12 kB",
    "10.0 MB",
    "2000 TB",
  ]);
});

test("times have the unit of their size, without 60 s", () => {
  assert.deepEqual([0.04, 9.94, 9.96, 59.4, 59.6, 3599.4, 3600, 7290].map(seconds), [
    "0.0 s",
    "9.9 s",
    "10 s",
    "59 s",
    "1 min 0 s",
    "59 min 59 s",
    "1 h 0 min",
    "2 h 2 min",
  ]);
});

test("a project shows the state of its job while that matters", () => {
  const view = (state) => ({ job: { state } });
  assert.equal(stateOf({ finished: true }, view("running")), "running");
  assert.equal(stateOf({ finished: false }, view("succeeded")), "finished");
  assert.equal(stateOf({ finished: false }, undefined), "unfinished");
  assert.equal(stateOf({ finished: true, usability: "good" }, undefined), "sound");
  assert.equal(stateOf({ finished: true, usability: "check" }, view("succeeded")), "check");
  const ruined = { finished: true, summary: { verdict: { usability: "do not use" } } };
  assert.equal(stateOf(ruined, undefined), "unusable");
  assert.equal(stateOf(null, view("failed")), "failed");
});

test("the time left is given once it is known", () => {
  const status = { what: "pairs" };
  assert.equal(
    runProgressText({ run_progress: 0, run_eta_s: null, status: { what: "" } }),
    "Starting",
  );
  assert.equal(
    runProgressText({ run_progress: 0.124, run_eta_s: null, status }),
    "12 % of the run",
  );
  assert.equal(
    runProgressText({ run_progress: 0.5, run_eta_s: 61, status }),
    "50 % of the run · about 1 min 1 s left",
  );
  assert.equal(
    runProgressText({ run_progress: 0.99, run_eta_s: 0.2, status }),
    "99 % of the run · nearly done",
  );
});

test("progress names how far, how fast and how long", () => {
  const status = { done: 1200, unit: "pairs", rate_per_s: 8.26, eta_s: 30 };
  assert.equal(progressText({ status, fraction: 0.4 }), "This part 40 % · 8.3 pairs/s · 30 s left");
  const ofBytes = { ...status, unit: "B", done: 3_400_000, rate_per_s: 12_345_678 };
  assert.equal(
    progressText({ status: ofBytes, fraction: null }),
    "This part 3.4 MB · 12 MB/s · 30 s left",
  );
  assert.equal(
    progressText({ status: { ...status, rate_per_s: 0, eta_s: null }, fraction: null }),
    `This part 1${NARROW}200 pairs`,
  );
});
