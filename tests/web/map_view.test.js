import "./english.js?map";

import assert from "node:assert/strict";
import { test } from "node:test";

import {
  axesOf,
  between,
  dot,
  eyeOf,
  cornersOf,
  fitted,
  lookedAround,
  minus,
  panned,
  rayAt,
  toScreen,
  zoomed,
} from "../../web/map/camera.js";
import { boxOver, cornersOfBox, planesOf, yawOfSection } from "../../web/map/clip.js";
import { nearestTo, positionAt, standingAt, walking } from "../../web/map/flight.js";
import { cornersShown } from "../../web/map/framing.js";
import { angleOf, areaOf, distanceParts, resultOf, toCsv } from "../../web/map/measure.js";
import { format, parse } from "../../web/map/state.js";
import { mapQuery } from "../../web/slices/to_map.js";

const SCREEN = { width: 800, height: 600 };
const CAMERA = { target: [4, 5, 1], yaw: 0.6, pitch: -0.7, distance: 12, parallel: false };
const PARALLEL = { ...CAMERA, parallel: true };

const near = (a, b, within = 1e-6) =>
  [a].flat().forEach((x, k) => assert.ok(Math.abs(x - [b].flat()[k]) < within, `${a} ${b}`));

// -- camera

for (const camera of [CAMERA, PARALLEL])
  test(`a ray goes through the point of its pixel, parallel ${camera.parallel}`, () => {
    const p = [5.5, 7, 0.3];
    const { x, y } = toScreen(camera, SCREEN, p);
    const { origin, direction } = rayAt(camera, SCREEN, [x, y]);
    const to = minus(p, origin);
    const along = dot(to, direction);
    near(
      minus(
        to,
        direction.map((d) => d * along),
      ),
      [0, 0, 0],
    );
    assert.ok(along > 0);
  });

test("from above north is up and east is right", () => {
  const top = { ...PARALLEL, yaw: 0, pitch: -Math.PI / 2 };
  const middle = toScreen(top, SCREEN, [4, 5, 1]);
  near([middle.x, middle.y], [400, 300]);
  assert.ok(toScreen(top, SCREEN, [5, 5, 1]).x > 401);
  assert.ok(toScreen(top, SCREEN, [4, 6, 1]).y < 299);
});

test("what is zoomed to stays under the pointer", () => {
  for (const camera of [CAMERA, PARALLEL]) {
    const p = [6, 4, 0.2];
    const before = toScreen(camera, SCREEN, p);
    const after = toScreen(zoomed(camera, 0.4, p), SCREEN, p);
    near([before.x, before.y], [after.x, after.y], 1e-6);
  }
});

test("what is grabbed follows the pointer", () => {
  const p = [6, 4, 0.2];
  const before = toScreen(CAMERA, SCREEN, p);
  const after = toScreen(panned(CAMERA, SCREEN, [30, -20], p), SCREEN, p);
  near([after.x - before.x, after.y - before.y], [30, -20], 1e-6);
});

test("who looks around stays where they are", () => {
  const around = lookedAround(CAMERA, 50, 20);
  near(eyeOf(around), eyeOf(CAMERA));
  assert.notEqual(around.yaw, CAMERA.yaw);
});

test("a fitted camera shows all points in the free part of the image, and fills it", () => {
  const free = { left: 380, right: 120, up: 200, down: 260 };
  const corners = cornersOf([-3, -2, 0], [20, 9, 3]);
  for (const parallel of [false, true]) {
    const camera = fitted({ yaw: 0.5, pitch: -0.9, parallel }, { screen: SCREEN, free }, corners);
    const seen = corners.map((p) => toScreen(camera, SCREEN, p));
    const [xs, ys] = [seen.map(({ x }) => x - 400), seen.map(({ y }) => 300 - y)];
    const [left, right, down, up] = [xs, ys].flatMap((all) => [Math.min(...all), Math.max(...all)]);
    assert.ok(left >= -free.left && right <= free.right && down >= -free.down && up <= free.up);
    const filled = [(right - left) / (free.left + free.right), (up - down) / (free.down + free.up)];
    assert.ok(Math.max(...filled) > 0.95, `${filled}`);
    near([(left + right) / 2, (down + up) / 2], [-130, -30], 15); // in its middle
  }
});

test("what the clip leaves of the tiles is fitted, without stray points", () => {
  const tile = (x) => ({ low_m: [x, 0, 0], high_m: [x + 4, 4, 3] });
  const index = { tiles: [tile(0), tile(4), tile(90)], low_m: [0, 0, 0], high_m: [8, 4, 2.5] };
  const clip = { heights: [null, null], box: null, section: null };
  const box = { center: [4, 2, 1], size: [2, 2, 9], yaw: Math.PI / 4 };
  const section = { a: [0, 1], b: [8, 1], thickness: 0.5 };
  const ends = (/** @type {any} */ changes) => {
    const corners = cornersShown(index, { ...clip, ...changes });
    return [0, 1, 2].map((k) => [Math.min, Math.max].map((of) => of(...corners.map((p) => p[k]))));
  };
  near(ends({}).flat(), [0, 8, 0, 4, 0, 2.5]);
  near(ends({ heights: [1, 2] })[2], [1, 2]);
  near(ends({ box }).flat(), [
    4 - Math.SQRT2,
    4 + Math.SQRT2,
    2 - Math.SQRT2,
    2 + Math.SQRT2,
    0,
    2.5,
  ]);
  near(ends({ section }).flat(), [0, 8, 0.75, 1.25, 0, 2.5]);
  near(ends({ heights: [7, 9] }).flat(), [0, 8, 0, 4, 0, 2.5]); // nothing is left: all
});

test("a turn takes the shorter way", () => {
  const half = between({ ...CAMERA, yaw: 3 }, { ...CAMERA, yaw: -3 }, 0.5);
  near(Math.abs(half.yaw), Math.PI);
});

// -- clip

test("a box keeps its inside, also a turned one", () => {
  const box = { center: [3, 4, 1], size: [2, 6, 2], yaw: 0.4 };
  const planes = planesOf({ heights: [null, null], box, section: null });
  const keeps = (p) => planes.every(([x, y, z, d]) => x * p[0] + y * p[1] + z * p[2] + d >= -1e-9);
  assert.equal(planes.length, 6);
  assert.ok(keeps([3, 4, 1]) && cornersOfBox(box).every(keeps));
  assert.ok(!keeps([3 + 1.2, 4 + 0.5, 1]) && !keeps([3, 4, 2.1]));
});

test("a dragged rectangle becomes the box over it", () => {
  const { center, size } = boxOver([1, 2], [5, 8], { yaw: 0, heights: [-1, 2] });
  near(center, [3, 5, 0.5]);
  near(size, [4, 6, 3]);
});

test("one looks at a section with its beginning at the left", () => {
  const section = { a: [1, 2], b: [5, 4], thickness: 0.2 };
  const camera = { ...PARALLEL, target: [3, 3, 1], pitch: 0, yaw: yawOfSection(section) };
  const [a, b] = [section.a, section.b].map((p) => toScreen(camera, SCREEN, [...p, 1]));
  assert.ok(a.x < b.x);
  near([a.y, b.y], [300, 300]);
  near(a.depth, b.depth);
  assert.equal(planesOf({ heights: [0, 2], box: null, section }).length, 4);
});

// -- measuring

test("measurements are what they are called", () => {
  const { length, horizontal, vertical } = distanceParts([0, 0, 0], [3, 4, 12]);
  near([length, horizontal, vertical], [13, 5, 12]);
  near(
    angleOf([
      [1, 0, 0],
      [0, 0, 0],
      [0, 0, 2],
    ]),
    90,
  );
  const square = [
    [0, 0, 0],
    [2, 0, 2],
    [2, 3, 2],
    [0, 3, 0],
  ];
  near([areaOf(square).area, areaOf(square).plan], [3 * Math.hypot(2, 2), 6]);
});

test("a measurement says its standard deviation only if it is stated", () => {
  const made = {
    kind: "distance",
    name: "d",
    points: [
      [0, 0, 0],
      [1, 0, 0],
    ],
  };
  assert.ok(!resultOf(made).parts.includes("σ"));
  assert.ok(resultOf({ ...made, sd: [0.003, 0.004] }).parts.includes("σ 5.0 mm"));
  assert.ok(!resultOf({ ...made, sd: [0.003, NaN] }).parts.includes("σ"));
});

test("a name cannot become a formula in a table", () => {
  const points = [[1, 2, 3]];
  const rows = toCsv([{ kind: "point", name: '=1+"2"', points }], null).split("\r\n");
  assert.ok(rows[1].startsWith('"\'=1+""2""",point,1,1.0000,2.0000,3.0000'), rows[1]);
});

// -- the slices

test("a map is shown as it was left to look at its section as a slice, else with the plane", () => {
  const left = "color=height&section=1,2,5,4.5,0.2&camera=1,2,3,4,5,6,0&layers=walk";
  const slice = { kind: "vertical", z: 0, a: [1, 2], b: [5, 4.5], t: 0.2 };
  assert.deepEqual(parse(mapQuery(slice, left)), parse(left));
  const other = parse(mapQuery({ ...slice, t: 0.1 }, left));
  assert.deepEqual([other.camera, other.color, other.layers], [null, "height", ["walk"]]);
  assert.equal(other.clip.section.thickness, 0.1);
  const level = parse(mapQuery({ ...slice, kind: "horizontal", z: 1 }, left));
  assert.deepEqual([level.clip.section, level.clip.heights], [null, [0.9, 1.1]]);
});

test("the plane of a slice is shown on the map", () => {
  const { clip } = parse(mapQuery({ kind: "vertical", z: 0, a: [1, 2], b: [5, 4.5], t: 0.2 }));
  assert.deepEqual(clip.section, { a: [1, 2], b: [5, 4.5], thickness: 0.2 });
  const level = parse(mapQuery({ kind: "horizontal", z: 1.5, a: [0, 0], b: [1, 0], t: 0.1 }));
  assert.deepEqual(level.clip.heights, [1.45, 1.55]);
  assert.equal(mapQuery({ kind: "free", z: 0, a: [0, 0], b: [1, 0], t: 1 }), "");
});

// -- the walk

const WALK = {
  t_s: [0, 1, 3],
  positions_m: [
    [0, 0, 1],
    [2, 0, 1],
    [2, 8, 1],
  ],
};

test("positions lie between those of the walk", () => {
  near(positionAt(WALK, 2), [2, 4, 1]);
  near(positionAt(WALK, -5), [0, 0, 1]);
  near(positionAt(WALK, 50), [2, 8, 1]);
});

test("who walks is at the walk and looks along it", () => {
  const camera = walking(WALK, 1.5, { ...CAMERA, yaw: 0 });
  near(eyeOf(camera), [2, 2, 1]);
  near(axesOf(camera).ahead[0], 0, 0.05);
});

test("the place of the walk nearest to a click is found", () => {
  const { time, away } = nearestTo(WALK, { origin: [2.1, 8, 20], direction: [0, 0, -1] });
  assert.equal(time, 3);
  assert.ok(away < 0.01);
  near(eyeOf(standingAt([1, 2, 3], 0.3, 0)), [1, 2, 3]);
});

// -- the address

test("the address keeps the whole state", () => {
  const state = parse("");
  Object.assign(state, {
    camera: { target: [1.5, -2, 0.25], yaw: 0.5, pitch: -0.5, distance: 7.125, parallel: true },
    color: "time",
    lo: 3,
    layers: ["findings", "walk"],
    mark: {
      span: [40, 44.5],
      place: [
        [1, 2, 0],
        [3, 4, 0.5],
      ],
    },
    cutCeiling: false,
    depth: false,
    size: 2,
    measurements: [
      {
        kind: "height",
        points: [
          [0, 0, 1],
          [0, 0.5, 2.25],
        ],
        name: "Door, left",
        sd: [0.00125, NaN],
        snaps: ["corner", ""],
      },
      {
        kind: "profile",
        points: [
          [0, 0, 1],
          [5, 0.5, 1],
        ],
        name: "Profile 1",
        sd: [NaN, NaN],
        snaps: ["", "plane"],
        figure: 0.35,
      },
    ],
    clip: {
      heights: [null, 2.5],
      box: { center: [1, 2, 3], size: [4, 5, 6], yaw: 0.1 },
      section: { a: [0, 0], b: [4, 1], thickness: 0.5 },
    },
  });
  const again = parse(format(state));
  near(again.camera.yaw, 0.5, 1e-3);
  near(again.camera.target, [1.5, -2, 0.25]);
  assert.deepEqual({ ...again, camera: null }, { ...state, camera: null });
  assert.equal(format(parse(format(again))), format(again));
});

test("a link says the standard deviation of a distance, and to what its ends snapped", () => {
  const made = {
    kind: "distance",
    points: [
      [0, 0, 0],
      [3, 0, 0],
    ],
    name: "Wall",
    sd: [0.003, 0.004],
    snaps: ["edge", "plane"],
  };
  const [opened] = parse(format({ ...parse(""), measurements: [made] })).measurements;
  assert.deepEqual(opened, made);
  assert.equal(resultOf(opened).parts, resultOf(made).parts);
  assert.match(toCsv([opened], null), /,edge,3.0000,3.0000,0.0000,0.0050,/);
});

test("a link of before, with points only, is read; a wrong σ is none", () => {
  const [one] = parse("m=distance;0,0,0;3,0,0,-1,x;Wall").measurements;
  assert.deepEqual(
    [one.sd, one.snaps],
    [
      [NaN, NaN],
      ["", ""],
    ],
  );
  assert.equal(format({ ...parse(""), measurements: [one] }), "m=distance;0,0,0;3,0,0;Wall");
});

test("an address that is not ours shows the usual", () => {
  const query =
    "camera=1,2&color=__proto__&z=a..b&box=1,2,3,-1,1,1,0&section=1,1,1,1,1&size=1e9&m=x;1,2,3;n" +
    "&m=distance;1,2,3;n&m=profile:x;1,2,3;n&lo=NaN&camera=1,2,3,4,5,0,0&layers=all";
  const { camera, color, clip, measurements, lo, layers } = parse(query);
  assert.deepEqual(
    { camera, color, clip, measurements, lo, layers },
    {
      camera: null,
      color: null,
      clip: { heights: [null, null], box: null, section: null },
      measurements: [],
      lo: null,
      layers: [],
    },
  );
});
