import "./english.js";

import assert from "node:assert/strict";
import { test } from "node:test";

import {
  factsIn,
  firstText,
  isReason,
  spanIn,
  stretchOf,
  stretchText,
  unobservedText,
  verdictLists,
  verdictState,
} from "../../web/shared/verdict.js";
import { rowsOf, ticksOf } from "../../web/shared/walk_rows.js";

const LOST = "Tracking was lost in 314 of 545 multiframes.";
const CORRIDOR = {
  start_s: 33.2,
  end_s: 61.8,
  direction: "horizontal",
  degeneracy: 0.00123,
  from_m: [1, 2, 0],
  to_m: [31, 2.04, 0.1],
};

test("a map without a verdict is not good", () => {
  const states = ["good", "check", "do not use"].map((usability) => verdictState({ usability }));
  assert.deepEqual(states, ["sound", "check", "unusable"]);
  assert.equal(verdictState(null), "unjudged");
  assert.equal(verdictState({ usability: "splendid" }), "unjudged");
});

test("every note stands there once, findings first", () => {
  const verdict = { usability: "do not use", reasons: [LOST], unobserved: [CORRIDOR] };
  const notes = [LOST, "half of the clocks are missing"];
  const lists = verdictLists({ verdict, notes, findings: null });

  assert.deepEqual(
    lists.map(([, texts]) => texts),
    [[LOST], [unobservedText(CORRIDOR)], ["half of the clocks are missing"]],
  );
  assert.deepEqual(verdictLists({ verdict: null, notes: [], findings: null }), []);
});

test("what is not observable has time, direction and place", () => {
  assert.equal(
    unobservedText(CORRIDOR),
    "33 s to 62 s: a horizontal direction, degeneracy 0.0012, " +
      "from x 1.0, y 2.0, z 0.0 m to x 31.0, y 2.0, z 0.1 m",
  );
  const unknown = { ...CORRIDOR, direction: "", from_m: [], to_m: [] };
  assert.equal(unobservedText(unknown), "33 s to 62 s: one direction, degeneracy 0.0012");
});

test("a project before its first map has no facts of one", () => {
  assert.equal(factsIn({}), null);
  assert.equal(factsIn(undefined), null);
  assert.deepEqual(factsIn({ points: 3 }), {
    verdict: null,
    notes: [],
    findings: null,
    figures: { duration_s: undefined },
  });
  assert.deepEqual(factsIn({ points: 3, warnings: ["no IMU"] }).notes, ["no IMU"]);
  const findings = [
    { level: "good", text: "Tracking was not lost." },
    { level: "note", text: "The rig is old." },
  ];
  assert.deepEqual(factsIn({ points: 3, findings }).notes, ["The rig is old."]);
});

test("the bar says the worst finding, of earlier versions the first reason", () => {
  const verdict = { usability: "check", reasons: [LOST], unobserved: [] };
  const findings = /** @type {any} */ ([{ level: "check", text: "It is old." }]);
  assert.equal(firstText({ verdict, notes: [], findings }), "It is old.");
  assert.equal(firstText({ verdict, notes: [], findings: null }), LOST);
  assert.equal(firstText({ verdict: null, notes: [], findings: [] }), "");
});

test("a finding names its stretch by times and places", () => {
  const place_m = /** @type {any} */ ([
    [1, 2, 0],
    [3.5, -2, 0],
  ]);
  assert.equal(stretchOf({ span_s: [12, 15.25], place_m }), "span=12,15.25&place=1,2,0,3.5,-2,0");
  assert.equal(stretchOf({ place_m }), "place=1,2,0,3.5,-2,0");
  assert.equal(stretchOf({}), "");
  assert.equal(stretchText({ span_s: [12, 15.25] }), "12.0 s to 15.3 s");
  assert.equal(stretchText({ span_s: [12, 12] }), "12.0 s");
  assert.equal(stretchText({ place_m }), "x 1.0, y 2.0, z 0.0 m");
});

test("blanks are no reason", () => {
  const map = { reason_needed: "the verdict is do not use", min_reason_characters: 10 };
  assert.equal(isReason("         checked          ", map), false);
  assert.equal(isReason("checked with tape", map), true);
  assert.equal(isReason("", { ...map, reason_needed: "" }), true);
});

test("each stretch has its place on the time axis, and none covers another", () => {
  const of = (/** @type {any} */ ...span_s) => /** @type {any} */ ({ span_s, kind: span_s[0] });
  const rows = rowsOf(
    [of(20, 40), of(10, 30), of(50, 50), { kind: "no stretch" }, of(95, 300)],
    100,
  );

  assert.deepEqual(
    rows.map((row) => row.map(({ finding, left, width }) => [finding.kind, left, width])),
    [
      [
        [10, 10, 20],
        [50, 50, 0.8],
        [95, 95, 5],
      ],
      [[20, 20, 20]],
    ],
  );
  assert.deepEqual(rowsOf([of(100, 100)], 100)[0]?.[0]?.left, 99.2);
});

test("the ticks of a time axis are few and round", () => {
  assert.deepEqual(ticksOf(60), [0, 10, 20, 30, 40, 50, 60]);
  assert.deepEqual(ticksOf(59.9), [0, 10, 20, 30, 40, 50]);
  assert.deepEqual(ticksOf(1000), [0, 200, 400, 600, 800, 1000]);
});

test("an address marks a span in its fragment or its query", () => {
  assert.equal(spanIn({ hash: "#span=40,44&place=1", search: "" }), "40,44");
  assert.equal(spanIn({ hash: "", search: "?kind=free&span=1,2" }), "1,2");
  assert.equal(spanIn({ hash: "", search: "" }), "");
});
