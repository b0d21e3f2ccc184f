// The drawing of a rig as shapes in the body frame [m]. No DOM, no network.

import { matrixOf, placed } from "./rig_math.js";
import { asWritten, t } from "../shared/texts.js";

/**
 * @import {Rig, RigSensor, Triple} from "./rig_math.js"
 * @typedef {(point: number[]) => number[]} Put a point of a part in the body
 * @typedef {object} Shape
 * @property {"face" | "line" | "text"} kind
 * @property {number[][]} points
 * @property {string} role what it belongs to: selects the color
 * @property {number} [alpha] opacity of a face
 * @property {string} [text]
 * @property {boolean} [dashed]
 * @property {number} [width] of a line [px]
 */

/** Diameter and height of the sensors [m], from their data sheets. */
/** @type {Record<string, [number, number]>} */
const SIZES = {
  "VLP-16": [0.103, 0.072],
  "VLP-16 Hi-Res": [0.103, 0.072],
  "VLP-32C": [0.103, 0.087],
  "HDL-32E": [0.085, 0.144],
  "HDL-64E": [0.203, 0.283],
};
/** @type {[number, number]} */
const OTHER_SIZE = [0.08, 0.08];
const REACH_M = 0.42; // how far a field of view is drawn
const BODY_AXES_M = 0.19;
const SEGMENTS = 40;
const TURN = 2 * Math.PI;
const COLORS = 4; // of sensors
const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
const IMU_M = [0.024, 0.018, 0.01]; // half of its size
const ANTENNA_M = [0.12, 0.012];

/**
 * @param {number} radius
 * @param {number} z
 */
const circle = (radius, z, count = SEGMENTS) =>
  Array.from({ length: count }, (_, k) => {
    const angle = (TURN * k) / count;
    return [radius * Math.cos(angle), radius * Math.sin(angle), z];
  });

const pairs = (/** @type {number[][]} */ points) =>
  points.map((point, /** @type {number} */ k) => [point, points[(k + 1) % points.length]]);

/**
 * The quadrilaterals between two rings of the same number of points.
 * @param {number[][]} low
 * @param {number[][]} high
 */
const between = (low, high) =>
  pairs(low).map(([a, b], /** @type {number} */ k) => [a, b, high[(k + 1) % high.length], high[k]]);

/**
 * @param {number[][]} points
 * @param {string} role
 * @param {number} alpha
 */
const face = (points, role, alpha) => ({ kind: "face", points, role, alpha });
/**
 * @param {number[][]} points
 * @param {string} role
 */
const line = (points, role, width = 1) => ({ kind: "line", points, role, width });
/**
 * @param {number[]} at
 * @param {string} role
 * @param {string} text
 */
const label = (at, role, text) => ({ kind: "text", points: [at], role, text });

/**
 * @param {number[]} given
 * @param {number} height
 */
const above = ([x, y, z], height) => [x, y, z + height];

/**
 * The axes of a frame, with their names if they are those of the body.
 * @param {Put} put
 * @param {number} length
 */
function axes(put, length, named = false) {
  return Object.entries(AXES).flatMap(([name, axis]) => {
    const end = put(axis.map((value) => value * length));
    const role = `axis-${name}`;
    return [line([put([0, 0, 0]), end], role, 2), ...(named ? [label(end, role, name)] : [])];
  });
}

/**
 * @param {Put} put
 * @param {string} role
 */
function cylinder(put, /** @type {number[]} */ [diameter, height], role) {
  const [low, high] = [-height / 2, height / 2].map((z) => circle(diameter / 2, z, 24).map(put));
  return [
    ...between(low, high).map((points) => face(points, role, 0.9)),
    face(low, `${role}-end`, 0.95),
    face(high, `${role}-end`, 0.95),
  ];
}

/**
 * The band between the lowest and the highest beam: two cones and the surface between them.
 * @param {Put} put
 * @param {number[]} given
 * @param {string} role
 */
function band(put, [lowest, highest], role) {
  const ring = (/** @type {number} */ degrees) => {
    const angle = (degrees * Math.PI) / 180;
    return circle(REACH_M * Math.cos(angle), REACH_M * Math.sin(angle)).map(put);
  };
  const [low, high, center] = [ring(lowest), ring(highest), put([0, 0, 0])];
  return [
    ...between(low, high).map((points) => face(points, role, 0.13)),
    ...[...pairs(low), ...pairs(high)].map((edge) => face([center, ...edge], role, 0.05)),
    line([...low, low[0]], role),
    line([...high, high[0]], role),
  ];
}

/**
 * The plane a 2-D laser or an unknown LiDAR sweeps; `upright`: the x-z plane of a profiler.
 * @param {Put} put
 * @param {string} role
 * @param {boolean} upright
 */
function disc(put, role, upright) {
  const flat = circle(REACH_M, 0);
  const ring = (upright ? flat.map(([x, y]) => [x, 0, y]) : flat).map(put);
  return [face(ring, role, 0.08), { ...line([...ring, ring[0]], role), dashed: true }];
}

/**
 * @param {RigSensor} sensor
 * @param {number} k
 * @param {Record<string, number[] | null>} elevations
 */
function sensorShapes(sensor, k, elevations) {
  const R = matrixOf(sensor.rpy_deg);
  const put = (/** @type {number[]} */ point) => placed(R, sensor.xyz_m, point);
  const role = sensor.enabled ? `sensor-${k % COLORS}` : "disabled";
  const elevation = sensor.kind === "lidar" ? elevations[sensor.model] : null;
  const size = SIZES[sensor.model] ?? OTHER_SIZE;
  return [
    ...(elevation ? band(put, elevation, role) : disc(put, role, sensor.kind === "profiler")),
    ...cylinder(put, size, role),
    ...axes(put, 0.11),
    label(above(sensor.xyz_m, 0.09), role, sensor.name),
  ];
}

/**
 * @param {Put} put
 * @param {number[]} half
 * @param {string} role
 */
function box(put, half, role) {
  const corner = (/** @type {number[]} */ signs) =>
    put(signs.map((sign, axis) => sign * half[axis]));
  const square = [
    [-1, -1],
    [1, -1],
    [1, 1],
    [-1, 1],
  ];
  return [0, 1, 2].flatMap((axis) =>
    [-1, 1].map((side) => {
      const points = square.map((at) => corner(at.toSpliced(axis, 0, side)));
      return face(points, role, 0.95);
    }),
  );
}

function antennaShapes(/** @type {number[]} */ arm) {
  const put = (/** @type {number[]} */ point) => point.map((value, axis) => value + arm[axis]);
  return [
    { ...line([[0, 0, 0], arm], "gnss"), dashed: true },
    ...cylinder(put, ANTENNA_M, "gnss"),
    label(above(arm, 0.045), "gnss", t("gnss-antenna")),
  ];
}

/**
 * The shapes of a rig. An antenna in the origin of the body is not drawn: its place is not known.
 * @param {Rig} content
 * @param {Record<string, number[] | null>} elevations lowest and highest beam of each model [deg]
 * @returns {Shape[]}
 */
export function shapesOf(content, elevations) {
  const R = matrixOf(content.imu.rpy_deg);
  const imu = (/** @type {number[]} */ point) => placed(R, content.imu.xyz_m, point);
  const arm = content.gnss.lever_arm_m;
  return /** @type {Shape[]} */ ([
    ...axes((point) => point, BODY_AXES_M, true),
    ...content.sensors.flatMap((sensor, k) => sensorShapes(sensor, k, elevations)),
    ...box(imu, IMU_M, "imu"),
    ...axes(imu, 0.06),
    label(above(content.imu.xyz_m, -0.045), "imu", "IMU"),
    ...(arm.some((value) => value !== 0) ? antennaShapes(arm) : []),
  ]);
}

/** Middle and radius of what is drawn [m]; fields of view are cut. */
export function boundsOf(/** @type {Rig} */ content) {
  const places = [
    [0, 0, 0],
    content.imu.xyz_m,
    content.gnss.lever_arm_m,
    ...content.sensors.map((sensor) => sensor.xyz_m),
  ];
  const [low, high] = [Math.min, Math.max].map((pick) =>
    [0, 1, 2].map((axis) => pick(...places.map((place) => place[axis]))),
  );
  const middle = low.map((value, axis) => (value + high[axis]) / 2);
  const radius = Math.hypot(...low.map((value, axis) => high[axis] - value)) / 2;
  return { middle, radius: Math.max(radius + 0.35, 0.5) };
}

/** The rig in words, for those who do not see the drawing. */
export function describe(/** @type {Rig} */ content) {
  const place = (/** @type {number[]} */ xyz) =>
    xyz.map((value) => Math.round(100 * value)).join(", ");
  const sensors = content.sensors.map(({ name, model, xyz_m, rpy_deg }) => {
    const turned = rpy_deg.map(asWritten).join(t("gap"));
    return t("described-sensor", { name, model, place: place(xyz_m), turned });
  });
  return t("described", { name: content.name, sensors: sensors.join("; ") });
}
