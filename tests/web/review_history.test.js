import "./english.js?review";

import assert from "node:assert/strict";
import { test } from "node:test";

import { figureText, historyOf, judgmentText } from "../../web/review/history.js";

const judgment = (more) => ({
  by: "search",
  verdict: "accepted",
  reason: "",
  measure: "",
  value: null,
  limit: null,
  person: "",
  note: "",
  ...more,
});
const FOUND = judgment({ measure: "error_m", value: 0.0072, limit: 0.11 });
const EVA = judgment({ by: "person", verdict: "rejected", person: "Eva", note: "glass" });
const FREE = { who: "", why: "", state: "accepted" };

test("a figure stands with its limit in the unit of its measure", () => {
  const figure = (measure, value, limit) => figureText({ measure, value, limit });
  assert.equal(figure("error_m", 0.0072, 0.11), "error 7.2 mm, limit 11 cm");
  assert.equal(figure("overlap", 0.31, 0.4), "overlap 31 %, limit 40 %");
  assert.equal(figure("seen_through", 0.00076, 0.2), "seen through 0.076 %, limit 20 %");
  assert.equal(figure("chi2", 812.3, null), "squared residual 812");
  assert.equal(figure("", null, null), "");
});

test("a verdict says who gave it and why", () => {
  const contradicted = judgment({
    by: "verification",
    verdict: "rejected",
    reason: "verification median > limit",
    measure: "verification_m",
    value: 0.4,
    limit: 0.1,
  });
  assert.deepEqual(judgmentText(contradicted), {
    by: "verification",
    verdict: "rejected",
    why: "verification median > limit; path discrepancy 40 cm, limit 10 cm",
  });
  assert.deepEqual(judgmentText(EVA), { by: "Eva", verdict: "rejected", why: "glass" });
});

test("an edge that no path confirms has no figure but says so", () => {
  const alone = judgment({ by: "verification", verdict: "unverified", measure: "verification_m" });
  assert.equal(judgmentText(alone).why, "no alternative path");
});

test("a decision that is not in the map yet is the last of the history", () => {
  const row = { who: "Ada", why: "same door", state: "accepted" };
  const history = historyOf([FOUND], row);
  assert.deepEqual(history.at(-1), {
    by: "Ada",
    verdict: "accepted",
    why: "same door",
    pending: true,
  });
  assert.equal(historyOf([FOUND], FREE).length, 1);
});

test("a decision in the map stands once, and one that was undone says so", () => {
  const row = { who: "Eva", why: "glass", state: "rejected" };
  assert.deepEqual(
    historyOf([FOUND, EVA], row).map((one) => one.by),
    ["search", "Eva"],
  );
  assert.equal(historyOf([FOUND, EVA], FREE).at(-1).verdict, "left to the program");
});
