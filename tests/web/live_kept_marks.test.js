import "./english.js";

import assert from "node:assert/strict";
import { test } from "node:test";

const stored = new Map();
globalThis.localStorage = /** @type {any} */ ({
  getItem: (key) => stored.get(key) ?? null,
  setItem: (key, text) => stored.set(key, text),
});
globalThis.location = /** @type {any} */ ({ pathname: "/live", origin: "https://example.org" });

const { keptMarks, sendKept, sendOrKeep } = await import("../../web/live/kept_marks.js");

const sent = [];

/** A server that answers each mark with the next status; 0 = there is no link. */
function answering(...statuses) {
  globalThis.fetch = /** @type {any} */ (
    async (url, options) => {
      if (!url.endsWith("/api/live/marks")) return Response.json({ role: "admin", token: "" });
      const status = statuses.shift() ?? 201;
      if (status === 0) throw new TypeError("no link");
      if (status === 201) sent.push(JSON.parse(options.body).text);
      return Response.json({ detail: "", status: "noted" }, { status });
    }
  );
}

async function keepTwo() {
  stored.clear();
  sent.length = 0;
  answering(0, 0);
  const mark = { project: "walk", what: /** @type {const} */ ("point"), at_ms: Date.now() };
  for (const text of ["door", "crack"]) assert.equal(await sendOrKeep({ ...mark, text }), false);
}

const texts = (marks) => marks.map(({ text }) => text);

test("marks are sent in their order once there is a link", async () => {
  await keepTwo();
  answering();
  assert.deepEqual(await sendKept("walk"), { left: 0, refused: [] });
  assert.deepEqual(sent, ["door", "crack"]);
  assert.deepEqual(keptMarks(), []);
});

test("what the server will never take is named, and the others are sent", async () => {
  await keepTwo();
  answering(422);
  const { left, refused } = await sendKept("walk");
  assert.deepEqual([left, texts(refused), sent], [0, ["door"], ["crack"]]);
});

test("marks of an earlier capture are named", async () => {
  await keepTwo();
  answering();
  const { left, refused } = await sendKept("another walk");
  assert.deepEqual([left, texts(refused), sent], [0, ["door", "crack"], []]);
});

test("a server that is busy loses no mark", async () => {
  await keepTwo();
  answering(201, 503);
  assert.deepEqual(await sendKept("walk"), { left: 1, refused: [] });
  assert.deepEqual(texts(keptMarks()), ["crack"]);
  answering();
  assert.equal((await sendKept("walk")).left, 1, "not again at once");
  assert.deepEqual(sent, ["door"]);
});
