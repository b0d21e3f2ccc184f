// Colors of the differences between two maps. No DOM, no network.

/** Bytes of a core point: x, y, z (float32), distance, level of detection, state, normal. */
const POINT_BYTES = 20;
export const STATE = { below: 0, significant: 1, alone: 2 };
/** Behind the surface of this map, through no difference, to in front of it. */
const BEHIND = [
  [33, 60, 156],
  [54, 117, 204],
  [122, 178, 228],
];
const FRONT = [
  [246, 178, 107],
  [222, 98, 62],
  [158, 22, 40],
];
export const BELOW = [168, 172, 176];
export const ALONE = [186, 84, 196];
export const OTHER = [116, 120, 124];

/** The colors from the end behind to the end in front, for a legend. */
export const RAMP = [...BEHIND, BELOW, ...FRONT];

/**
 * The color of a significant distance; beyond the end it is that of the end.
 * @param {number} distance [m]
 * @param {number} reach distance at the ends of the colors [m]
 */
export function differenceColor(distance, reach) {
  const side = distance < 0 ? [...BEHIND].reverse() : FRONT;
  const at = Math.min(1, Math.abs(distance) / reach) * (side.length - 1);
  const k = Math.min(Math.floor(at), side.length - 2);
  return side[k].map((from, axis) => from + (at - k) * (side[k + 1][axis] - from));
}

/**
 * Core points as arrays.
 * @param {ArrayBuffer} data
 * @param {number} step of distances and levels of detection [m]
 */
export function decoded(data, step) {
  const count = Math.floor(data.byteLength / POINT_BYTES);
  const view = new DataView(data);
  const points = {
    count,
    places: new Float32Array(3 * count),
    distances: new Float32Array(count),
    states: new Uint8Array(count),
    normals: new Int8Array(3 * count),
  };
  for (let k = 0, at = 0; k < count; k++, at += POINT_BYTES) {
    for (let axis = 0; axis < 3; axis++) {
      points.places[3 * k + axis] = view.getFloat32(at + 4 * axis, true);
      points.normals[3 * k + axis] = view.getInt8(at + 17 + axis);
    }
    points.distances[k] = step * view.getInt16(at + 12, true);
    points.states[k] = view.getUint8(at + 16);
  }
  return points;
}

/**
 * Red, green and blue of each core point, 0 to 255.
 * @param {Pick<ReturnType<typeof decoded>, "count" | "distances" | "states">} points
 * @param {number} reach distance at the ends of the colors [m]
 */
export function colorsOf({ count, distances, states }, reach) {
  const colors = new Uint8Array(3 * count);
  for (let k = 0; k < count; k++) {
    const state = states[k];
    const color =
      state === STATE.significant
        ? differenceColor(distances[k], reach)
        : state === STATE.below
          ? BELOW
          : state === STATE.alone
            ? ALONE
            : OTHER;
    colors.set(color, 3 * k);
  }
  return colors;
}

/**
 * The usual end of the colors: a round number of millimeters that most distances stay below.
 * @param {{p95_m: number, lod_p50_m: number} | null | undefined} figures
 */
export function usualReach(figures) {
  const wanted = Math.max(figures?.p95_m ?? 0, 2 * (figures?.lod_p50_m ?? 0), 0.005);
  const steps = [0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5];
  return steps.find((step) => step >= wanted) ?? 5;
}
