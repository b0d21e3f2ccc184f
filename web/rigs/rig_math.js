// Rotations and differences of rigs. No DOM, no network. Matrices are lists of rows.

import { asWritten, decimal, t, wordOf } from "../shared/texts.js";

/**
 * @import {GnssContent, ImuContent, RigContent, SensorContent} from "../shared/http_types"
 * @typedef {[number, number, number]} Triple
 * @typedef {Required<SensorContent>} RigSensor
 * @typedef {Required<ImuContent>} RigImu
 * @typedef {Required<GnssContent>} RigGnss
 * @typedef {Omit<RigContent, "sensors" | "imu" | "gnss"> &
 *   {sensors: RigSensor[], imu: RigImu, gnss: RigGnss}} Rig a rig as the server sends it: whole
 * @typedef {Pick<RigSensor, "xyz_m" | "rpy_deg" | "time_offset_s">} Mount
 */

const RAD = Math.PI / 180;

/** Rz(yaw) Ry(pitch) Rx(roll) of angles in degrees: maps the sensor's axes into the body. */
export function matrixOf(/** @type {number[]} */ [roll, pitch, yaw]) {
  const [cr, sr] = [Math.cos(roll * RAD), Math.sin(roll * RAD)];
  const [cp, sp] = [Math.cos(pitch * RAD), Math.sin(pitch * RAD)];
  const [cy, sy] = [Math.cos(yaw * RAD), Math.sin(yaw * RAD)];
  return [
    [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
    [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
    [-sp, cp * sr, cp * cr],
  ];
}

/**
 * A point of the sensor in the body.
 * @param {number[][]} R
 * @param {number[]} origin
 * @param {number[]} given
 */
export const placed = (R, origin, [x, y, z]) =>
  R.map((row, /** @type {number} */ k) => origin[k] + row[0] * x + row[1] * y + row[2] * z);

/**
 * The rotation vector, in the body and degrees, that turns one mount into another.
 * @param {number[]} before
 * @param {number[]} after
 */
export function rotationBetween(before, after) {
  const [A, B] = [matrixOf(before), matrixOf(after)];
  const D = [0, 1, 2].map((i) =>
    [0, 1, 2].map((j) => B[i].reduce((sum, value, k) => sum + value * A[j][k], 0)),
  );
  const axis = [D[2][1] - D[1][2], D[0][2] - D[2][0], D[1][0] - D[0][1]];
  const [sine, cosine] = [Math.hypot(...axis) / 2, (D[0][0] + D[1][1] + D[2][2] - 1) / 2];
  const angle = Math.atan2(sine, cosine);
  if (sine > 1e-9) return axis.map((value) => ((value / 2 / sine) * angle) / RAD);
  if (cosine > 0) return [0, 0, 0];
  const k = [0, 1, 2].reduce((best, one) => (D[one][one] > D[best][best] ? one : best), 0);
  const row = D[k].map((value, j) => value + (j === k ? 1 : 0)); // a half turn
  const length = Math.hypot(...row);
  return row.map((value) => (value / length) * 180);
}

const AXES = ["x", "y", "z"];
/**
 * @param {number} value
 * @param {number} digits
 */
const signed = (value, digits) => `${value < 0 ? "−" : "+"}${decimal(Math.abs(value), digits)}`;

/**
 * ["x +1.00", …] of the components that round to something else than zero.
 * @param {number[]} values
 * @param {number} digits
 */
const components = (values, digits) =>
  values.flatMap((value, /** @type {number} */ k) =>
    Math.abs(value) < 0.5 * 10 ** -digits ? [] : [`${AXES[k]} ${signed(value, digits)}`],
  );

/**
 * @param {Pick<Mount, "time_offset_s">} before
 * @param {Pick<Mount, "time_offset_s">} after
 */
const clockChange = (before, after) => {
  const change = 1e3 * (after.time_offset_s - before.time_offset_s);
  return Math.abs(change) < 5e-4 ? [] : [t("change-clock", { change: signed(change, 3) })];
};

/**
 * @param {Mount} before
 * @param {Mount} after
 */
function mountChanges(before, after) {
  const shift = after.xyz_m.map(
    (value, /** @type {number} */ k) => 100 * (value - before.xyz_m[k]),
  );
  const turn = rotationBetween(before.rpy_deg, after.rpy_deg);
  return [
    ...components(shift, 2).map((/** @type {string} */ text) =>
      t("change-position", { change: text }),
    ),
    ...components(turn, 3).map((/** @type {string} */ text) =>
      t("change-rotation", { change: text }),
    ),
    ...clockChange(before, after),
  ];
}

const valueText = (/** @type {string | number} */ value) =>
  typeof value === "number" && value ? asWritten(value) : String(value || t("none"));

const PLAIN = [
  "kind",
  "model",
  "serial",
  "address",
  "port",
  "topic",
  "head_topic",
  "head_rate_deg_s",
  "clock_rate_ppm",
];
/**
 * @param {Record<string, any>} before
 * @param {Record<string, any>} after
 * @param {string[]} keys
 */
const plainChanges = (before, after, keys) =>
  keys
    .filter((/** @type {string} */ key) => before[key] !== after[key])
    .map(
      (/** @type {string} */ key) =>
        `${wordOf("field", key)} ${valueText(before[key])} → ${valueText(after[key])}`,
    );

/**
 * @param {RigSensor} before
 * @param {RigSensor} after
 */
function sensorChanges(before, after) {
  const used =
    before.enabled === after.enabled
      ? []
      : [after.enabled ? t("change-enabled") : t("change-disabled")];
  return [...mountChanges(before, after), ...plainChanges(before, after, PLAIN), ...used];
}

/**
 * @param {RigGnss} before
 * @param {RigGnss} after
 */
function gnssChanges(before, after) {
  const arm = after.lever_arm_m.map(
    (value, /** @type {number} */ k) => 100 * (value - before.lever_arm_m[k]),
  );
  return [
    ...components(arm, 2).map((/** @type {string} */ text) =>
      t("change-lever-arm", { change: text }),
    ),
    ...clockChange(before, after),
    ...plainChanges(before, after, ["port", "serial"]),
  ];
}

/**
 * What differs between two versions of a rig: lines of text; the sensors are found by name.
 * @param {Rig} before
 * @param {Rig} after
 */
export function changesOf(before, after) {
  /**
   * @param {string} label
   * @param {string[]} texts
   */
  const of = (label, texts) => texts.map((/** @type {string} */ text) => `${label}: ${text}`);
  const earlier = new Map(before.sensors.map((sensor) => [sensor.name, sensor]));
  const names = new Set(after.sensors.map((sensor) => sensor.name));
  const kept = after.sensors.flatMap((sensor) => {
    const old = earlier.get(sensor.name);
    return of(sensor.name, old ? sensorChanges(old, sensor) : [t("change-added")]);
  });
  const removed = [...earlier.keys()].filter((name) => !names.has(name));
  return [
    ...(before.name === after.name
      ? []
      : [t("change-name", { before: before.name, after: after.name })]),
    ...kept,
    ...removed.map((name) => t("change-removed", { name })),
    ...of(t("imu"), mountChanges(before.imu, after.imu)),
    ...of(t("imu"), plainChanges(before.imu, after.imu, ["port"])),
    ...of(t("gnss-antenna"), gnssChanges(before.gnss, after.gnss)),
  ];
}

/**
 * A number without trailing zeros, at most `digits` decimals.
 * @param {number} value
 * @param {number} digits
 */
export const short = (value, digits) => String(Number(value.toFixed(digits)));

/** A name for a folder, from a file name or another name. */
export const slug = (/** @type {string} */ text) =>
  text
    .replace(/(-v\d+)?\.toml$/i, "")
    .replace(/[^A-Za-z0-9._-]+/g, "-")
    .replace(/^[^A-Za-z0-9]+/, "")
    .slice(0, 64);
