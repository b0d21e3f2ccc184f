import assert from "node:assert/strict";
import { test } from "node:test";

import { addTexts, decimal, hasText, language, t, wordOf } from "../../web/shared/texts.js";

addTexts(
  "de",
  `width = { DECIMAL($m, digits: 1) } m
part = { PERCENT($ratio, digits: 1) }
points = { COUNT($points) } Punkte
step-loop-closures = Schleifenschlüsse
stage-graph = Graph
off = { DECIMAL($m, digits: 1, sign: 1) } m, { DEGREES($rad, digits: 0) }, { LENGTH($short) }
gaps = { $count ->
    [one] eine Lücke
   *[other] { $count } Lücken
}
`,
);
addTexts(
  "en",
  "step-graph = graph\nwidth = { DECIMAL($m, digits: 1) } m wide\nonly = English { $count }",
);

test("numbers are written as the language does, with the digits that the text asks for", () => {
  assert.equal(language(), "de");
  assert.equal(t("width", { m: 12.34 }), "12,3 m");
  assert.equal(t("part", { ratio: 0.051 }), "5,1 %");
  assert.equal(t("points", { points: 1234567 }), "1\u202f234\u202f567 Punkte");
  assert.equal(t("off", { m: 1.25, rad: Math.PI, short: 0.123 }), "+1,3 m, 180°, 12,3 cm");
  assert.equal(decimal(12.34, 1), "12,3");
  assert.equal(decimal(-0.04, 1), "0,0");
  assert.equal(t("off", { m: -0.04, rad: 0, short: 0 }), "+0,0 m, 0°, 0,0 cm");
});

test("a text selects by number", () => {
  assert.equal(t("gaps", { count: 1 }), "eine Lücke");
  assert.equal(t("gaps", { count: 3 }), "3 Lücken");
});

test("what a language lacks is English, and what nobody has is its name", () => {
  assert.equal(t("only", { count: "12345" }), "English 12345");
  assert.ok(hasText("only") && !hasText("nothing"));
  assert.equal(t("nothing"), "nothing");
});

test("a word of the server is shown in the language, or as the server wrote it", () => {
  assert.equal(wordOf("step", "Loop closures"), "Schleifenschlüsse");
  assert.equal(wordOf("step", "of tomorrow"), "of tomorrow");
  assert.equal(wordOf("stage", "graph"), "Graph");
  assert.equal(wordOf("step", "Graph"), "Graph");
});
