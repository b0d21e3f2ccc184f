// Orthographic camera of the map, from above or tilted, and its control by fingers and mouse.

import { listenToGestures } from "../shared/gestures.js";

const ABOVE = Math.PI / 2;
const TILTED = 0.62;
const MEANT_TURN = 0.2; // smaller rotations of a pinch are unintended [rad]
const FIT = 0.9;

export class Camera {
  target = [0, 0, 0];
  pxPerM = 24;
  yaw = 0;
  pitch = ABOVE;

  get above() {
    return this.pitch === ABOVE;
  }

  tilt() {
    this.pitch = this.above ? TILTED : ABOVE;
  }

  /** Rotation into the image (right, up, toward the viewer), by columns. */
  get turn() {
    const [c, s, u, f] = [
      Math.cos(this.yaw),
      Math.sin(this.yaw),
      Math.sin(this.pitch),
      Math.cos(this.pitch),
    ];
    return [c, -s * u, s * f, s, c * u, -c * f, 0, f, u];
  }

  /**
   * Pixel coordinates of a point, relative to the target in the image, y down.
   * @returns {[number, number]}
   */
  project(/** @type {number[]} */ [x, y, z]) {
    const t = this.turn;
    const [a, b, c] = [x - this.target[0], y - this.target[1], z - this.target[2]];
    return [
      (t[0] * a + t[3] * b + t[6] * c) * this.pxPerM,
      -(t[1] * a + t[4] * b + t[7] * c) * this.pxPerM,
    ];
  }

  /**
   * @param {number} dx
   * @param {number} dy
   */
  pan(dx, dy) {
    const [c, s] = [Math.cos(this.yaw), Math.sin(this.yaw)];
    const right = -dx / this.pxPerM;
    const up = dy / this.pxPerM / Math.max(Math.sin(this.pitch), 0.3);
    this.target[0] += c * right - s * up;
    this.target[1] += s * right + c * up;
  }

  /**
   * @param {number} dx
   * @param {number} dy
   */
  orbit(dx, dy) {
    this.yaw -= dx * 0.008;
    this.pitch = Math.min(Math.max(this.pitch + dy * 0.006, 0.12), ABOVE - 0.01);
  }

  /** Zooms about the pixel `x`, `y` relative to the target. */
  zoom(/** @type {number} */ factor, /** @type {number[]} */ [x, y] = [0, 0]) {
    const before = this.pxPerM;
    this.pxPerM = Math.min(Math.max(before * factor, 1), 400);
    const grown = this.pxPerM / before;
    this.pan(x - x * grown, y - y * grown);
  }

  /** Rotates the image clockwise about the pixel `x`, `y` relative to the target. */
  rotate(/** @type {number} */ angle, /** @type {number[]} */ [x, y] = [0, 0]) {
    this.yaw += angle;
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    this.pan(x - (c * x - s * y), y - (s * x + c * y));
  }

  /**
   * Fits a horizontal box, [[x, y], [x, y]], into a window of `width` x `height` pixels.
   * @param {number[][]} given
   * @param {{width: number, height: number}} given1
   */
  fit([[x0, y0], [x1, y1]], { width, height }) {
    this.target = [(x0 + x1) / 2, (y0 + y1) / 2, this.target[2]];
    this.pxPerM = 1;
    const corners = [
      [x0, y0],
      [x0, y1],
      [x1, y0],
      [x1, y1],
    ].map(([x, y]) => this.project([x, y, this.target[2]]));
    const [wide, high] = [0, 1].map(
      (axis) => 2 * Math.max(1, ...corners.map((corner) => Math.abs(corner[axis]))),
    );
    this.zoom(FIT * Math.min(width / wide, height / high));
  }
}

/**
 * One finger pans (or orbits in 3-D), two zoom, rotate and pan, a wheel zooms. `middle()` is the
 * target's position in the element [px]; while `following()` fingers zoom and rotate about it and
 * do not pan.
 * @param {HTMLElement} element
 * @param {Camera} camera
 * @param {{onMove: () => void, onPan: () => void, middle: () => number[],
 *   following: () => boolean}} on
 */
export function moveByPointer(element, camera, { onMove, onPan, middle, following }) {
  let turned = 0; // rotation of the current touch
  const about = (/** @type {number[]} */ [x, y]) => {
    const [left, top] = middle();
    return following() ? [0, 0] : [x - left, y - top];
  };

  /**
   * @param {number} angle
   * @param {number[]} place
   */
  function rotate(angle, place) {
    const turn = Math.atan2(Math.sin(angle), Math.cos(angle));
    turned += turn;
    if (Math.abs(turned) > MEANT_TURN) camera.rotate(turn, place);
  }

  listenToGestures(element, {
    onDown: () => (turned = 0),
    onDrag(from, to, { shiftKey }) {
      const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
      if (!camera.above && !shiftKey) camera.orbit(dx, dy);
      else {
        camera.pan(dx, dy);
        if (dx || dy) onPan();
      }
      onMove();
    },
    onPinch(before, after) {
      const place = about(before.middle);
      camera.zoom(after.apart / Math.max(before.apart, 1), place);
      rotate(after.angle - before.angle, place);
      if (!following())
        camera.pan(after.middle[0] - before.middle[0], after.middle[1] - before.middle[1]);
      onMove();
    },
    onWheel(deltaY, at) {
      camera.zoom(Math.exp(-deltaY * 0.0015), about(at));
      onMove();
    },
  });
}
