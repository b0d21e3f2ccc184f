// The camera of the map: an orbit around a target, in perspective or parallel. No DOM, no network.
// x east, y north, z up; a yaw of 0 looks north and grows clockwise, a pitch of -90° looks down.

/**
 * @typedef {[number, number, number]} Xyz
 * @typedef {object} Camera
 * @property {Xyz} target what is in the middle of the image [m]
 * @property {number} yaw [rad]
 * @property {number} pitch [rad]
 * @property {number} distance from the eye to the target [m]
 * @property {boolean} parallel whether lines that are parallel stay so
 * @typedef {{width: number, height: number}} Screen [px]
 * @typedef {object} Free how far around its middle nothing covers the image [px]
 * @property {number} left
 * @property {number} right
 * @property {number} up
 * @property {number} down
 * @typedef {{screen: Screen, free: Free}} View
 * @typedef {{origin: Xyz, direction: Xyz}} Ray
 */

export const FIELD_OF_VIEW = Math.PI / 3; // from the lower to the upper rim
const STEEPEST = Math.PI / 2;
const NEAREST_M = 0.05;
const FARTHEST_M = 100_000;
const MARGIN = 1.04; // around what is fitted into the image: points are drawn larger than they are

/** @returns {Xyz} */
export const add = (/** @type {number[]} */ a, /** @type {number[]} */ b, times = 1) => [
  a[0] + times * b[0],
  a[1] + times * b[1],
  a[2] + times * b[2],
];
export const dot = (/** @type {number[]} */ a, /** @type {number[]} */ b) =>
  a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @returns {Xyz} */
export const minus = (/** @type {number[]} */ a, /** @type {number[]} */ b) => add(a, b, -1);
export const lengthOf = (/** @type {number[]} */ a) => Math.sqrt(dot(a, a));

/**
 * Unit vectors of the image: right, up, and ahead.
 * @param {Pick<Camera, "yaw" | "pitch">} look
 * @returns {{right: Xyz, up: Xyz, ahead: Xyz}}
 */
export function axesOf({ yaw, pitch }) {
  const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
  return { right: [cy, -sy, 0], up: [-sy * sp, -cy * sp, cp], ahead: [sy * cp, cy * cp, sp] };
}

/** Where the eye is [m]. */
export const eyeOf = (/** @type {Camera} */ camera) =>
  add(camera.target, axesOf(camera).ahead, -camera.distance);

/** Pixels that a meter takes at a meter's distance. */
export const focalPx = (/** @type {Screen} */ { height }) =>
  height / (2 * Math.tan(FIELD_OF_VIEW / 2));

/**
 * Meters of a pixel at the target.
 * @param {Camera} camera
 * @param {Screen} screen
 */
export const pixelM = (camera, screen) => camera.distance / focalPx(screen);

/**
 * Where a point is in the image [px], with its depth ahead of the eye [m]; null if behind it.
 * @param {Camera} camera
 * @param {Screen} screen
 * @param {number[]} p
 */
export function toScreen(camera, screen, p) {
  const { right, up, ahead } = axesOf(camera);
  const from = minus(p, eyeOf(camera));
  const depth = dot(from, ahead);
  if (!camera.parallel && depth < NEAREST_M) return null;
  const scale = focalPx(screen) / (camera.parallel ? camera.distance : depth);
  return {
    x: screen.width / 2 + scale * dot(from, right),
    y: screen.height / 2 - scale * dot(from, up),
    depth,
  };
}

/**
 * The ray through a pixel; in a parallel projection it begins `behind` meters behind the target.
 * @param {Camera} camera
 * @param {Screen} screen
 * @param {number[]} at
 * @returns {Ray}
 */
export function rayAt(camera, screen, [x, y], behind = 1000) {
  const { right, up, ahead } = axesOf(camera);
  const [dx, dy] = [x - screen.width / 2, screen.height / 2 - y];
  if (camera.parallel) {
    const scale = pixelM(camera, screen);
    const beside = add(add(camera.target, right, dx * scale), up, dy * scale);
    return { origin: add(beside, ahead, -behind), direction: ahead };
  }
  const focal = focalPx(screen);
  const through = add(add(ahead, right, dx / focal), up, dy / focal);
  const length = lengthOf(through);
  return { origin: eyeOf(camera), direction: add([0, 0, 0], through, 1 / length) };
}

/**
 * Turned about the target by a drag of some pixels.
 * @param {Camera} camera
 * @param {number} dx
 * @param {number} dy
 * @returns {Camera}
 */
export function orbited(camera, dx, dy) {
  return {
    ...camera,
    yaw: turned(camera.yaw + dx * 0.006),
    pitch: clamp(camera.pitch - dy * 0.006, -STEEPEST, STEEPEST),
  };
}

/**
 * Looking elsewhere from the same eye.
 * @param {Camera} camera
 * @param {number} dx
 * @param {number} dy
 * @returns {Camera}
 */
export function lookedAround(camera, dx, dy) {
  const eye = eyeOf(camera);
  const next = {
    ...camera,
    yaw: turned(camera.yaw - dx * 0.004),
    pitch: clamp(camera.pitch + dy * 0.004, -STEEPEST, STEEPEST),
  };
  return { ...next, target: add(eye, axesOf(next).ahead, camera.distance) };
}

/**
 * Moved so that what lies at the distance of `p` follows the pointer.
 * @param {Camera} camera
 * @param {Screen} screen
 * @param {number[]} shift [px]
 * @param {number[]} [p] what was grabbed; usually the target
 * @returns {Camera}
 */
export function panned(camera, screen, [dx, dy], p = camera.target) {
  const { right, up, ahead } = axesOf(camera);
  const depth = camera.parallel
    ? camera.distance
    : Math.max(dot(minus(p, eyeOf(camera)), ahead), NEAREST_M);
  const scale = depth / focalPx(screen);
  return { ...camera, target: add(add(camera.target, right, -dx * scale), up, dy * scale) };
}

/**
 * Nearer to `p` (`times` < 1) or farther from it; `p` stays where it is in the image.
 * @param {Camera} camera
 * @param {number} times
 * @param {number[]} [p]
 * @returns {Camera}
 */
export function zoomed(camera, times, p = camera.target) {
  const distance = clamp(camera.distance * times, NEAREST_M, FARTHEST_M);
  const real = distance / camera.distance;
  return { ...camera, distance, target: add(p, minus(camera.target, p), real) };
}

/**
 * All of some points in the free part of the image, as large as they can be.
 * @param {Pick<Camera, "yaw" | "pitch" | "parallel">} look
 * @param {View} view
 * @param {number[][]} points [m]
 * @returns {Camera}
 */
export function fitted({ yaw, pitch, parallel }, { screen, free }, points) {
  const { right, up, ahead } = axesOf({ yaw, pitch });
  const unit = focalPx(screen) * MARGIN;
  const depths = points.map((p) => dot(p, ahead));
  const across = [
    { axis: right, low: free.left / unit, high: free.right / unit },
    { axis: up, low: free.down / unit, high: free.up / unit },
  ].map(({ axis, low, high }) => {
    let [from, to] = [-Infinity, Infinity];
    points.forEach((p, k) => {
      const [x, z] = [dot(p, axis), parallel ? 0 : depths[k]];
      from = Math.max(from, x - high * z);
      to = Math.min(to, x + low * z);
    });
    return { low, high, from, to };
  });
  // The eye is as near as both directions allow, and in the middle of where it may be.
  const eye = Math.min(...across.map(({ low, high, from, to }) => (to - from) / (low + high)));
  const [x, y] = across.map(({ low, high, from, to }) => (from + high * eye + to - low * eye) / 2);
  let [near, far] = [Infinity, -Infinity];
  for (const z of depths) [near, far] = [Math.min(near, z), Math.max(far, z)];
  const depth = (near + far) / 2;
  const target = add(add(add([0, 0, 0], right, x), up, y), ahead, depth);
  const distance = Math.max(NEAREST_M, (parallel ? 0 : depth) - eye);
  return { target, yaw, pitch, distance, parallel };
}

/** The eight corners of a box. */
export const cornersOf = (/** @type {number[]} */ low, /** @type {number[]} */ high) =>
  Array.from({ length: 8 }, (_, k) =>
    [0, 1, 2].map((axis) => ((k >> axis) & 1 ? high : low)[axis]),
  );

/**
 * Between two cameras, 0 to 1: along the shorter turn.
 * @param {Camera} from
 * @param {Camera} to
 * @param {number} part
 * @returns {Camera}
 */
export function between(from, to, part) {
  const mix = (/** @type {number} */ a, /** @type {number} */ b) => a + part * (b - a);
  return {
    target: add(from.target, minus(to.target, from.target), part),
    yaw: turned(from.yaw + part * turned(to.yaw - from.yaw)),
    pitch: mix(from.pitch, to.pitch),
    distance: Math.exp(mix(Math.log(from.distance), Math.log(to.distance))),
    parallel: to.parallel,
  };
}

const clamp = (/** @type {number} */ x, /** @type {number} */ low, /** @type {number} */ high) =>
  Math.min(high, Math.max(low, x));

/** The same angle between -π and π. */
const turned = (/** @type {number} */ angle) => Math.atan2(Math.sin(angle), Math.cos(angle));
