import "./english.js?slices";

import assert from "node:assert/strict";
import { test } from "node:test";

import { cutText, distanceText, imageText, pointText } from "../../web/slices/captions.js";

test("a caption names the map, the color and the points", () => {
  const sources = [{ id: "v1", kind: "project", name: "Hall", label: "" }];
  const image = { color: "time", points: "12", surface: "raw" };
  const of = (source) => imageText({ source, ...image }, sources);
  assert.equal(of(""), "This map · Time · 12 points as measured");
  assert.equal(of("v1"), "Project Hall · Time · 12 points as measured");
  assert.equal(of("gone"), "gone · Time · 12 points as measured");
});

test("a plane is named by its numbers", () => {
  const at = { normal: [0.6, 0, 0.8], offset_m: 1.25, azimuth_deg: 9.96 };
  assert.equal(cutText({ ...at, kind: "horizontal" }), "Horizontal z = 1.250 m");
  assert.equal(cutText({ ...at, kind: "vertical" }), "Vertical azimuth 10.0°, offset 1.250 m");
  const free = "Free plane normal (0.600, 0.000, 0.800), offset 1.250 m";
  assert.equal(cutText({ ...at, kind: "free" }), free);
});

test("a point is given in the map and in the coordinate reference system", () => {
  const point = {
    p_map: [1, 2, 3],
    p_crs: [500001, 5, 6],
    about: { intensity: 7, sensor: 1, time_s: 8.04, frame_id: 9 },
  };
  assert.equal(
    pointText(point, { crs: "EPSG:25832", sensors: ["front"] }),
    "x y z  1.000  2.000  3.000 m · EPSG:25832  E N H  500001.000  5.000  6.000 m · " +
      "intensity 7 · sensor 1 · 8.0 s, multiframe 9",
  );
});

test("a distance has its horizontal and its vertical part", () => {
  assert.equal(
    distanceText({ p_map: [0, 0, 0] }, { p_map: [3, 4, 12] }),
    "Distance 13.000 m · horizontal 5.000 m · vertical 12.000 m · " +
      "from 0.000  0.000  0.000 to 3.000  4.000  12.000",
  );
});
