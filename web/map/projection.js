// The camera of the map as three.js has it.

import { axesOf, eyeOf, focalPx } from "./camera.js";
import { depthsOf } from "./lod.js";

/**
 * @import {Camera, Screen} from "./camera.js"
 * @import {PerspectiveCamera} from "../shared/vendor/three/three.module.min.js"
 */

/**
 * Gives three our camera.
 * @param {PerspectiveCamera} three
 * @param {Camera} camera
 * @param {{screen: Screen, bounds: {low: number[], high: number[]}}} view bounds of what is drawn
 * @returns {{near: number, far: number, turn: number[]}} the depths between which it draws, and the
 *   rotation from the map to the eye, column by column
 */
export function placeCamera(three, camera, { screen: { width, height }, bounds }) {
  const { right, up, ahead } = axesOf(camera);
  const eye = eyeOf(camera);
  const back = ahead.map((x) => -x);
  const { matrixWorld, matrixWorldInverse, projectionMatrix } = three;
  const rows = [0, 1, 2].map((k) => [right[k], up[k], back[k], eye[k]]);
  matrixWorld.set(...rows.flat(), 0, 0, 0, 1);
  matrixWorldInverse.copy(matrixWorld).invert();
  const depths = depthsOf(camera, bounds);
  const margin = 1 + 0.01 * (depths.far - depths.near);
  const far = Math.max(depths.far + margin, 2);
  const near = camera.parallel
    ? depths.near - margin
    : Math.max(depths.near - margin, far / 4000, 0.03);
  if (camera.parallel) {
    const tall = (camera.distance * height) / focalPx({ width, height }) / 2;
    const wide = (tall * width) / height;
    const [a, b] = [-2 / (far - near), -(far + near) / (far - near)];
    projectionMatrix.set(1 / wide, 0, 0, 0, 0, 1 / tall, 0, 0, 0, 0, a, b, 0, 0, 0, 1);
  } else {
    const tall = focalPx({ width, height }) / (height / 2);
    const wide = (tall * height) / width;
    const [a, b] = [-(far + near) / (far - near), (-2 * far * near) / (far - near)];
    projectionMatrix.set(wide, 0, 0, 0, 0, tall, 0, 0, 0, 0, a, b, 0, 0, -1, 0);
  }
  three.projectionMatrixInverse.copy(projectionMatrix).invert();
  return { near, far, turn: [0, 1, 2].flatMap((k) => [right[k], up[k], back[k]]) };
}
