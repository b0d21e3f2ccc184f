import "./english.js";

import assert from "node:assert/strict";
import { test } from "node:test";

import { difference, near } from "../../web/review/difference.js";

const WIDTH = 6;
const mask = (...rows) => Uint8Array.from(rows.join("").replaceAll(".", "0").replaceAll("#", "1"));
const drawn = (codes) =>
  Array.from({ length: codes.length / WIDTH }, (_, row) =>
    [...codes.subarray(row * WIDTH, (row + 1) * WIDTH)].join("").replaceAll("0", "."),
  );

test("a pixel reaches a square around it, not around the edge of the image", () => {
  assert.deepEqual(drawn(near(mask("......", "#.....", "......", "......"), WIDTH, 1)), [
    "11....",
    "11....",
    "11....",
    "......",
  ]);
  assert.deepEqual(drawn(near(mask("......", ".....#"), WIDTH, 2)), ["...111", "...111"]);
});

test("walls on each other agree, a wall beside the other does not", () => {
  const wall = mask("######", "......", "......", "......");
  const beside = mask("......", "......", "......", "######");
  const onIt = mask("......", "######", "......", "......");

  assert.equal(difference(wall, onIt, { width: WIDTH, reach: 1 }).agreeing, 1);
  const apart = difference(wall, beside, { width: WIDTH, reach: 1 });
  assert.deepEqual(drawn(apart.codes), ["111111", "......", "......", "222222"]);
  assert.equal(apart.agreeing, 0);
});

test("what both have is no difference, however wide one of them is", () => {
  const { codes, agreeing } = difference(mask("###..."), mask("..####"), {
    width: WIDTH,
    reach: 1,
  });

  assert.deepEqual(drawn(codes), ["133322"]);
  assert.equal(agreeing, 0.5);
});

test("nothing drawn agrees in nothing", () => {
  const none = new Uint8Array(WIDTH);
  assert.equal(difference(none, none, { width: WIDTH, reach: 3 }).agreeing, 0);
});
