import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const ROOT = new URL("../../", import.meta.url);
const MAX_CHARACTERS = 100;
const MAX_LINES = 400;
const VENDORED = "web/shared/vendor/"; // of others, as published
const GENERATED = "web/shared/http_types.d.ts";

/** Files written by people, with their lines. */
const files = ["web/", "tests/web/"].flatMap((folder) =>
  readdirSync(fileURLToPath(new URL(folder, ROOT)), { recursive: true })
    .map((name) => folder + name)
    .filter((path) => /\.(js|ts|css|html)$/.test(path) && path !== GENERATED)
    .filter((path) => !path.startsWith(VENDORED) || path.endsWith(".d.ts"))
    .map((path) => ({ path, lines: readFileSync(new URL(path, ROOT), "utf8").split("\n") })),
);

test("no line of the pages has more than 100 characters", () => {
  const wide = files.flatMap(({ path, lines }) =>
    lines.flatMap((line, k) => ([...line].length > MAX_CHARACTERS ? [`${path}:${k + 1}`] : [])),
  );
  assert.deepEqual(wide, []);
});

test("no file of the pages has more than 400 lines", () => {
  const long = files.filter(({ lines }) => lines.length - 1 > MAX_LINES).map(({ path }) => path);
  assert.deepEqual(long, []);
});

test("each color that a page or the map of the phone names is declared", () => {
  const all = files.map(({ lines }) => lines.join("\n")).join("\n");
  const found = (pattern, text = all) => [...text.matchAll(pattern)].map(([, name]) => name);
  const declared = new Set(found(/(?:^|[\s{;"])--([\w-]+):/g));
  const drawn = found(/"(\w+)"/g, all.match(/const COLORS = \[(.*)\]/)[1]);

  assert.ok(drawn.includes("path") && declared.size > 20);
  const named = [...found(/var\(--([\w-]+)\)/g), ...drawn];
  assert.deepEqual([...new Set(named)].filter((name) => !declared.has(name)).sort(), []);
});
