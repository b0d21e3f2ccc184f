import "./english.js?review";

import assert from "node:assert/strict";
import { test } from "node:test";

import {
  approvalObstacle,
  approvalText,
  decisionText,
  mapText,
} from "../../web/review/captions.js";

const DRAFT = { kind: "draft", text: "Draft: not approved", detail: "", checking: false, hash: "" };
const STATE = { busy: false, finished: true, in_map: true, may_review: true, approval: DRAFT };
const APPROVAL = {
  ...DRAFT,
  kind: "approved",
  text: "Approved v2 · Eva · 2026-01-02",
  hash: "ab12",
  verdict: "good",
  why: "",
};
const text = (more = {}) => approvalText({ ...APPROVAL, ...more });

test("a map is marked as approved only once its bytes were compared", () => {
  assert.equal(text(), "✓ Approved v2 · Eva · 2026-01-02");
  assert.match(text({ checking: true }), /^◷ Approved .*being compared with the signature$/);
});

test("the line of an approval is said by its code, in the language of the page", () => {
  const line = { text: "", code: "approval-changed", values: { version: 3 } };
  assert.equal(text({ kind: "changed", ...line, hash: "" }), "▲ Draft: changed since version 3");
});

test("whatever does not count is marked with the words of the server", () => {
  const kinds = ["draft", "earlier", "changed", "unknown signer", "not valid"];
  const marks = kinds.map((kind) => text({ kind, text: "words" }));
  assert.deepEqual(marks, ["◌ words", "▲ words", "▲ words", "✕ words", "✕ words"]);
});

test("the verdict that was overruled is named with the reason", () => {
  const why = { verdict: "do not use", why: "only the hall is needed" };
  assert.match(text(why), /, in spite of the verdict “do not use”: “only the hall/);
});

test("a person who cannot approve a map reads why", () => {
  assert.equal(approvalObstacle(STATE), "");
  assert.match(approvalObstacle({ ...STATE, may_review: false }), /permission to review/);
  assert.match(approvalObstacle({ ...STATE, busy: true }), /job/);
  assert.match(approvalObstacle({ ...STATE, finished: false }), /no finished map/);
  assert.match(approvalObstacle({ ...STATE, in_map: false }), /not in the map/);
  const signed = (kind) => ({ ...STATE, approval: { ...APPROVAL, kind } });
  assert.match(approvalObstacle(signed("approved")), /is approved/);
  for (const kind of ["changed", "unknown signer", "not valid"])
    assert.equal(approvalObstacle(signed(kind)), "");
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
