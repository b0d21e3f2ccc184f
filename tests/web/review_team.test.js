import "./english.js?review";

import assert from "node:assert/strict";
import { test } from "node:test";

import { agreementText, lookersText, workMark } from "../../web/review/team_captions.js";

const eva = { who: "Eva", accepted: true };
const jan = { who: "Jan", accepted: true };
const work = (/** @type {any} */ more) => ({
  opinions: [],
  agreement: "none",
  second_by: "",
  waits: false,
  ...more,
});

test("what people say together is one line", () => {
  assert.equal(agreementText(work({})), "");
  assert.equal(
    agreementText(work({ opinions: [eva, jan], agreement: "agree", second_by: "Eva" })),
    "✓ Eva and Jan agree: accepted",
  );
  const apart = { opinions: [eva, { ...jan, accepted: false }], agreement: "disagree" };
  assert.equal(agreementText(work(apart)), "▲ Eva accepted, Jan rejected");
  const waiting = { opinions: [eva], agreement: "one", second_by: "Eva", waits: true };
  assert.equal(agreementText(work(waiting)), "◌ Eva accepted it; Eva asked for a second opinion");
});

test("a row of the queue has a few letters of it", () => {
  assert.equal(workMark(undefined), "");
  const some = { assignee: "Jan", skipped_by: "Eva", comments: 2, waits: true };
  assert.equal(workMark(/** @type {any} */ (some)), "→ Jan · later · second opinion · ✎ 2");
});

test("who else is here, and who at this pair", () => {
  assert.equal(lookersText([], undefined), "Nobody else is looking now");
  const here = { who: "Eva", frame_i: 2, frame_j: 7 };
  const away = { who: "Jan", frame_i: null, frame_j: null };
  assert.equal(lookersText([here, away], [2, 7]), "Now here: Eva (at this pair), Jan");
  assert.equal(lookersText([here], [2, 9]), "Now here: Eva (multiframes 2 and 7)");
});
