import "./english.js?review&pair";

import assert from "node:assert/strict";
import { test } from "node:test";

import { ReviewState } from "../../web/review/state.js";

const SERVER = {
  work: [],
  graph: "g",
  seq: 0,
  standing: [],
  undoable: 0,
  redoable: 0,
  may_review: true,
};
const COLUMNS = ["frame_i", "frame_j", "verdict", "measured", "kind"];
const QUEUE = {
  columns: COLUMNS,
  rows: [
    [1, 9, "rejected", true, "loop"],
    [2, 8, "accepted", false, "loop"],
  ],
  began_ns: 0,
  limit_m: 0.1,
};

function reviewed(standing = []) {
  const state = new ReviewState();
  state.reset(SERVER, QUEUE);
  const added = state.update(/** @type {any} */ ({ ...SERVER, standing }));
  return { state, added };
}

const eva = { frame_i: 1, frame_j: 9, accepted: true, measured: false, who: "Eva", why: "glass" };

test("without decisions a row has the verdict of the program", () => {
  const { state } = reviewed();
  assert.deepEqual(
    state.rows.map((row) => [row.key, row.state, row.who]),
    [
      ["1-9", "rejected", ""],
      ["2-8", "accepted", ""],
    ],
  );
});

test("a decision changes the row of its pair and no other", () => {
  const { state } = reviewed([eva]);
  assert.deepEqual(state.refreshRows(), ["1-9"]);
  assert.equal(state.rows[0].state, "accepted");
  assert.equal(state.rows[0].who, "Eva");
});

test("a decision about a pair that the program never tried adds a row", () => {
  const { state, added } = reviewed([{ ...eva, frame_i: 3, frame_j: 7, measured: true }]);
  assert.deepEqual(
    added.map((row) => [row.key, row.kind, row.measured]),
    [["3-7", "manual", true]],
  );
  assert.equal(state.rows.length, 3);
});

test("a pair can be decided once its points are drawn, and once only", () => {
  const { state } = reviewed();
  const selected = state.select([1, 9], state.rows[0]);
  assert.equal(state.enabled(2).accept, false);
  selected.drawn = true;
  assert.equal(state.enabled(2).accept, true);
  selected.decided = true;
  assert.equal(state.enabled(2).accept, false);
});

test("a pair that is not registered cannot be accepted", () => {
  const { state } = reviewed();
  state.select([2, 8], state.rows[1]).drawn = true;
  const { accept, reject } = state.enabled(2);
  assert.deepEqual([accept, reject], [false, true]);
});

test("what follows from the decisions is shown at its row", () => {
  const { state } = reviewed([eva]);
  const moves = { moves: [{ t_ns: 2e9 }] };
  state.setEffect({
    last: moves,
    all: { ...moves, rejected_automatically: [[2, 8]], accepted_automatically: [] },
    edges: [{ pair: [2, 8], chi2: 5 }],
  });
  state.refreshRows();
  assert.equal(state.rows[1].state, "rejected");
  assert.equal(state.rows[1].chi2, 5);
});
