import "./english.js?projects";

import assert from "node:assert/strict";
import { test } from "node:test";

import { chosen, searchOf, tagCounts, twinsOf, wantedIn } from "../../web/projects/project_list.js";

const project = (id, more) => ({
  id,
  name: id,
  rig: "4RECON",
  preset: "indoor",
  tags: [],
  archived: false,
  recording: "",
  usability: "good",
  path_length_m: 1,
  ...more,
});
const ALL = [
  project("hall 10", { tags: ["Brno"], recording: "a", usability: "check", path_length_m: 5 }),
  project("hall 9", { tags: ["Brno", "2026"], recording: "b", path_length_m: 9 }),
  project("office", { recording: "a", usability: "do not use" }),
  project("old", { archived: true, tags: ["Brno"], recording: "b" }),
];
const WANTED = { text: "", order: "newest", show: "" };
const known = { twins: twinsOf(ALL), spaces: new Map([["office", { id: "office", bytes: 7 }]]) };
const ids = (changes) => chosen(ALL, { ...WANTED, ...changes }, known).map(({ id }) => id);

test("archived projects are shown only where they are asked for", () => {
  assert.deepEqual(ids({}), ["hall 10", "hall 9", "office"]);
  assert.deepEqual(ids({ show: "archived" }), ["old"]);
});

test("every word is searched in name, tags, rig and preset", () => {
  assert.deepEqual(ids({ text: "brno HALL 9" }), ["hall 9"]);
  assert.deepEqual(ids({ text: "4recon indoor" }).length, 3);
  assert.deepEqual(ids({ text: "hall nowhere" }), []);
});

test("projects are ordered by name with numbers, verdict, path length and size", () => {
  assert.deepEqual(ids({ order: "name" }), ["hall 9", "hall 10", "office"]);
  assert.deepEqual(ids({ order: "verdict" }), ["office", "hall 10", "hall 9"]);
  assert.deepEqual(ids({ order: "length" }), ["hall 9", "hall 10", "office"]);
  assert.equal(ids({ order: "size" })[0], "office");
});

test("projects of one recording are found, archived ones too", () => {
  assert.deepEqual(ids({ show: "twins" }), ["hall 10", "hall 9", "office", "old"]);
  assert.deepEqual(
    known.twins.get("office").map(({ id }) => id),
    ["hall 10"],
  );
  assert.equal(twinsOf([project("a"), project("b")]).size, 0); // not known is not the same
});

test("a tag is a group, and counts what is not archived", () => {
  assert.deepEqual(ids({ show: "tag:Brno" }), ["hall 10", "hall 9"]);
  assert.deepEqual(tagCounts(ALL), [
    ["2026", 1],
    ["Brno", 2],
  ]);
});

test("the address holds what is asked for", () => {
  const wanted = { text: "a b", order: "size", show: "tag:Brno" };
  assert.deepEqual(wantedIn(searchOf(wanted)), wanted);
  assert.equal(searchOf(WANTED), "");
  assert.equal(wantedIn("?order=constructor").order, "newest");
});
