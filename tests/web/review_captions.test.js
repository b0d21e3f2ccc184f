import assert from "node:assert/strict";
import { test } from "node:test";

import {
  approvalObstacle,
  approvalText,
  decisionText,
  mapText,
} from "../../web/review/captions.js";

const STATE = { busy: false, finished: true, in_map: true, may_review: true, approval: null };
const APPROVAL = {
  version: 2,
  who: "Eva",
  time: "2026-01-02T03:04:00+00:00",
  verdict: "good",
  why: "",
  current: true,
  altered: "",
};
const text = (check, more = {}) =>
  approvalText({ approval: { ...APPROVAL, check, ...more }, in_map: true });

test("a map is marked as approved only once its bytes were compared", () => {
  assert.match(text("checked"), /^✓ Approved: version 2 by Eva, /);
  assert.match(text("checking"), /^Approved: .*being compared with the signature$/);
  assert.match(text(""), /^Approved: .*not compared with the signature$/);
  assert.equal(
    text("altered", { altered: "map.laz differs" }),
    "✗ Altered since the approval: map.laz differs",
  );
});

test("without a current approval a map is a draft", () => {
  assert.equal(approvalText(STATE), "Draft, not approved");
  assert.match(text("", { current: false }), /^Draft. An earlier map was approved: version 2/);
  const decided = { approval: { ...APPROVAL, check: "checked" }, in_map: false };
  assert.match(
    approvalText(decided),
    /^Draft: decisions were made after the approval of version 2/,
  );
});

test("the verdict that was overruled is named with the reason", () => {
  const why = { verdict: "do not use", why: "only the hall is needed" };
  assert.match(text("checked", why), /, in spite of the verdict “do not use”: “only the hall/);
});

test("a person who cannot approve a map reads why", () => {
  assert.equal(approvalObstacle(STATE), "");
  assert.match(approvalObstacle({ ...STATE, may_review: false }), /permission to review/);
  assert.match(approvalObstacle({ ...STATE, busy: true }), /job/);
  assert.match(approvalObstacle({ ...STATE, finished: false }), /no finished map/);
  assert.match(approvalObstacle({ ...STATE, in_map: false }), /not in the map/);
  const approved = { ...STATE, approval: { ...APPROVAL, check: "checked" } };
  assert.match(approvalObstacle(approved), /is approved/);
  const altered = { ...STATE, approval: { ...APPROVAL, check: "altered" } };
  assert.equal(approvalObstacle(altered), "");
});

test("a map tells whether it has the decisions of people", () => {
  assert.match(mapText({ ...STATE, standing: [] }), /without decisions/);
  assert.match(mapText({ ...STATE, standing: [{}] }), /with these decisions/);
  assert.match(mapText({ ...STATE, in_map: false, standing: [{}] }), /not in the map yet/);
});

test("a rejection by the paths has their discrepancy and the limit", () => {
  const row = { kind: "loop", reason: "verification median > limit", verification_m: 0.4 };
  assert.equal(decisionText(row, 0.1), "Rejected automatically: path discrepancy 40 cm > 10 cm");
  assert.equal(decisionText({ kind: "loop", reason: "" }, 0.1), "Accepted automatically");
  assert.equal(decisionText({ kind: "manual" }, 0.1), "Created by a person");
});
