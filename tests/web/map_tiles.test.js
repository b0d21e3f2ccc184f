import "./english.js?map";

import assert from "node:assert/strict";
import { test } from "node:test";
import { setFlagsFromString } from "node:v8";
import { runInNewContext } from "node:vm";

import { moveByGestures } from "../../web/map/controls.js";
import { MapTiles } from "../../web/map/tiles.js";

// -- what is read of tiles

const TILE = {
  low_m: [0, 0, 0],
  high_m: [4, 4, 4],
  points: 50_000,
  sample: 500,
  coarse: 500,
  cube: 0,
  spacing_m: 0.02,
};
const CAMERA = { target: [2, 2, 2], yaw: 0, pitch: -1, distance: 10, parallel: false };
const ALL = [500, 49_500]; // of the cube, and the rest of its tile
const bytes = (stored, count, ofCube) =>
  new ArrayBuffer((stored !== "xyz" ? 2 : ofCube ? 11 : 10) * count);
const READER = {
  sample: async (stored) => bytes(stored, 500, true),
  parts: async (stored, parts) =>
    bytes(
      stored,
      parts.reduce((sum, { start, stop }) => sum + stop - start, 0),
      parts[0].ofCube,
    ),
};

/** Tiles of a map, and a wait until they read no more. */
function tilesOf(reader, count = 1, scene = { add() {}, remove() {} }) {
  const index = { tiles: Array.from({ length: count }, () => TILE), columns: [] };
  return new MapTiles(index, { scene, material: {}, reader, onLook() {} });
}

const settled = async () => {
  for (let k = 0; k < 50; k++) await new Promise(setImmediate);
};

test("what is wanted before the sample has come does not overlap it", async () => {
  const tiles = tilesOf(READER);

  const sample = tiles.readSample("intensity");
  tiles.want(ALL, CAMERA);
  await sample;
  await settled();

  const shown = tiles.show(ALL);
  assert.equal(tiles.total, 50_000);
  assert.equal(
    shown.reduce((sum, { points }) => sum + points, 0),
    50_000,
  );
  for (const { object } of shown) {
    const { place, value } = object.geometry.attributes;
    assert.equal(value.count, place.count);
  }
});

test("nothing of a chunk stays when its points are dropped", async () => {
  const added = [];
  let removed = 0;
  const scene = { add: (object) => added.push(new WeakRef(object)), remove: () => removed++ };
  const sample = async (stored) => bytes(stored, 150 * TILE.sample, true);
  const tiles = tilesOf({ ...READER, sample }, 150, scene);
  await tiles.readSample("");
  const halves = [(row) => row < 100, (row) => row >= 100];
  for (const isSeen of halves) {
    const counts = tiles.nodes.map(({ cube, points, row }) =>
      cube < 0 || isSeen(row) ? points : 0,
    );
    tiles.want(counts, CAMERA);
    await settled();
    tiles.show(counts);
  }

  setFlagsFromString("--expose-gc");
  await settled();
  runInNewContext("gc")();

  assert.ok(removed > 20);
  const alive = added.filter((one) => one.deref());
  assert.equal(alive.length, added.length - removed);
});

test("without a sample parts are read all the same", async () => {
  const tiles = tilesOf({ ...READER, sample: () => Promise.reject(new Error("no")) });

  tiles.want(ALL, CAMERA);
  await assert.rejects(tiles.readSample(""));
  tiles.want(ALL, CAMERA);
  await settled();

  assert.deepEqual(tiles.have, ALL);
});

test("few points of many tiles are read together, and not many more than are wanted", async () => {
  let asked = 0;
  const parts = async (stored, wanted) => {
    asked++;
    return READER.parts(stored, wanted);
  };
  const sample = async (stored) => bytes(stored, 500 * 600, true);
  const tiles = tilesOf({ ...READER, sample, parts }, 600);
  const counts = [300_000, ...Array.from({ length: 600 }, (_, k) => 10 + (k % 7))];

  await tiles.readSample("");
  tiles.want(counts, CAMERA);
  await settled();

  assert.ok(tiles.complete);
  assert.ok(tiles.have.every((n, k) => n >= counts[k] && n <= 2 * counts[k]));
  assert.ok(asked <= 600 / 20, `${asked} requests`);
});

test("values of another color are read together, each of its own points", async () => {
  const tiles = tilesOf(
    {
      sample: async (stored) => bytes(stored, 500 * 3, true),
      parts: async (stored, wanted) => {
        if (stored === "xyz") return READER.parts(stored, wanted);
        const values = wanted.flatMap(({ row, start, stop }) =>
          Array.from({ length: stop - start }, (_, k) => 1000 * row + start + k),
        );
        return Uint16Array.from(values).buffer;
      },
    },
    3,
  );
  await tiles.readSample("");
  const counts = [1500, 100, 200, 300];
  tiles.want(counts, CAMERA);
  await settled();

  await tiles.color("time");
  await settled();

  const known = tiles.show(counts).filter(({ object }) => object.geometry.drawRange);
  const firsts = known
    .map(({ object }) => object.geometry.attributes.value?.array[0])
    .filter((value) => value > 0);
  assert.deepEqual(firsts, [500, 1500, 2500]);
});

test("a server that refuses is asked again only when the camera moves", async () => {
  let [asked, camera] = [0, CAMERA];
  const parts = () => Promise.reject(new Error(`no ${++asked}`));
  const tiles = tilesOf({ ...READER, parts });
  tiles.onNews = () => tiles.want(ALL, camera); // as the canvas does: it draws again
  await tiles.readSample("");
  await settled();

  assert.equal(asked, 1);
  camera = { ...CAMERA };
  tiles.want(ALL, camera);
  await settled();
  assert.equal(asked, 2);
});

// -- drags of a tool

class Canvas extends EventTarget {
  getBoundingClientRect = () => ({ left: 0, top: 0 });
  setPointerCapture() {}
  focus() {}

  send(type, pointerId, [clientX, clientY], more = {}) {
    this.dispatchEvent(Object.assign(new Event(type), { pointerId, clientX, clientY, ...more }));
  }
}

/** A canvas with a tool that takes drags, and what was done on it. */
function withTool() {
  const [canvas, done] = [new Canvas(), []];
  const note = (what) => () => void done.push(what);
  moveByGestures(canvas, {
    camera: () => CAMERA,
    screen: () => ({ width: 800, height: 600 }),
    standing: () => false,
    dragging: () => true,
    move: note("move"),
    under: () => null,
    click: note("click"),
    drag: (_from, _to, ended) => void done.push(ended ? "made" : "drag"),
    cancel: note("cancel"),
  });
  return { canvas, done };
}

test("a drag of a tool ends it; one that moves the view does not", () => {
  const { canvas, done } = withTool();

  canvas.send("pointerdown", 1, [100, 100], { button: 0 });
  canvas.send("pointermove", 1, [150, 150], { buttons: 1, shiftKey: true });
  canvas.send("pointerup", 1, [150, 150], { button: 0 });
  assert.deepEqual(done.splice(0), ["move"]);

  canvas.send("pointerdown", 1, [100, 100], { button: 0 });
  canvas.send("pointermove", 1, [150, 150], { buttons: 1 });
  canvas.send("pointerup", 1, [150, 150], { button: 0 });
  assert.deepEqual(done, ["drag", "made"]);
});

test("two fingers zoom, and end no tool", () => {
  const { canvas, done } = withTool();

  canvas.send("pointerdown", 1, [100, 100], { button: 0 });
  canvas.send("pointermove", 1, [120, 120], { buttons: 1 });
  canvas.send("pointerdown", 2, [300, 300], { button: 0 });
  canvas.send("pointermove", 2, [350, 350], { buttons: 1 });
  canvas.send("pointerup", 2, [350, 350], { button: 0 });
  canvas.send("pointermove", 1, [160, 160], { buttons: 1 });
  canvas.send("pointerup", 1, [160, 160], { button: 0 });

  assert.deepEqual([...new Set(done)], ["drag", "cancel", "move"]);
});
