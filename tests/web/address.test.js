import "./english.js";

import assert from "node:assert/strict";
import { test } from "node:test";

// The module is below this path here, as it is below /recon4/web/shared/ on a server with a prefix.
const BASE = new URL("../../", import.meta.url).pathname;
const stored = { [`${BASE.slice(1)}sun`]: "1", "of another server": "2" };
const methods = {
  getItem: (key) => stored[key] ?? null,
  setItem: (key, text) => (stored[key] = text),
  removeItem: (key) => delete stored[key],
};
for (const [name, value] of Object.entries(methods))
  Object.defineProperty(stored, name, { value, enumerable: false });
globalThis.localStorage = /** @type {any} */ (stored);
globalThis.location = /** @type {any} */ ({
  origin: "https://example.org",
  pathname: `${BASE}projects/my%20office/review/`,
});

const { at, baseOf, forgetKept, idHere, keep, kept, pathHere, pathInside, socketUrl, wholeUrl } =
  await import("../../web/shared/address.js");

test("addresses begin where the module was loaded from", () => {
  assert.equal(at("/api/me"), `${BASE}api/me`);
  assert.equal(at("/"), BASE);
  assert.equal(wholeUrl("/pair"), `https://example.org${BASE}pair`);
  assert.equal(socketUrl("/api/live/stream"), `wss://example.org${BASE}api/live/stream`);
});

test("the key of the modules is no part of the server's path", () => {
  const key = "0123456789abcdef";
  for (const base of ["/", "/maps/old/", "/web/"])
    for (const keyed of ["web/", `web/${key}/`])
      assert.equal(baseOf(`https://example.org${base}${keyed}shared/address.js`), base);
});

test("the path of a page is that of the server", () => {
  assert.equal(pathHere(), "/projects/my%20office/review/");
  assert.equal(idHere(), "my office");
});

test("a login leads to a page of this server only", () => {
  for (const path of ["/live", "/projects/a/"]) assert.equal(pathInside(path), path);
  for (const path of ["//evil.example/", "https://evil.example/", "live", "/\\evil.example"])
    assert.equal(pathInside(path), "/");
  const sly = new URL(wholeUrl(pathInside("/a/..//evil.example/")), "https://example.org/login");
  assert.equal(sly.host, "example.org");
});

test("what the browser keeps is kept apart from that of other servers of the host", () => {
  assert.equal(kept("sun"), "1");
  keep("moon", "2");
  assert.equal(stored[`${BASE.slice(1)}moon`], "2");

  forgetKept();

  assert.deepEqual(Object.keys(stored), ["of another server"]);
});

test("what viewer and documentation kept is forgotten too, whatever the path of the server", () => {
  stored["viser-user:recon4.stretch.office"] = "span=1,2";
  stored[`${BASE}docs/.__palette`] = "{}";
  forgetKept();
  assert.equal(stored["viser-user:recon4.stretch.office"], undefined);
  assert.equal(stored[`${BASE}docs/.__palette`], undefined);
  assert.equal(stored["of another server"], "2");
});
