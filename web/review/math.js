// Poses as x y z qx qy qz qw, and the projection of the pair view. No DOM, no network.

export const IDENTITY = [0, 0, 0, 0, 0, 0, 1];

/** Rotation of a quaternion x y z w, row by row. */
export function rotationOf(/** @type {number[]} */ [x, y, z, w]) {
  const n = 2 / (x * x + y * y + z * z + w * w);
  return [
    1 - n * (y * y + z * z),
    n * (x * y - z * w),
    n * (x * z + y * w),
    n * (x * y + z * w),
    1 - n * (x * x + z * z),
    n * (y * z - x * w),
    n * (x * z - y * w),
    n * (y * z + x * w),
    1 - n * (x * x + y * y),
  ];
}

/**
 * @param {number[]} R
 * @param {number[]} given
 */
export const turn = (R, [x, y, z]) => [
  R[0] * x + R[1] * y + R[2] * z,
  R[3] * x + R[4] * y + R[5] * z,
  R[6] * x + R[7] * y + R[8] * z,
];

export const transposed = (/** @type {number[]} */ R) => [
  R[0],
  R[3],
  R[6],
  R[1],
  R[4],
  R[7],
  R[2],
  R[5],
  R[8],
];

/**
 * @param {number[]} A
 * @param {number[]} B
 */
export function times(A, B) {
  const out = [];
  for (let r = 0; r < 9; r += 3)
    for (let c = 0; c < 3; c += 1)
      out.push(A[r] * B[c] + A[r + 1] * B[c + 3] + A[r + 2] * B[c + 6]);
  return out;
}

/**
 * @param {number[]} pose
 * @param {number[]} p
 */
export const apply = (pose, p) => {
  const q = turn(rotationOf(pose.slice(3)), p);
  return [q[0] + pose[0], q[1] + pose[1], q[2] + pose[2]];
};

function product(
  /** @type {number[]} */ [ax, ay, az, aw],
  /** @type {number[]} */ [bx, by, bz, bw],
) {
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

/**
 * The pose moved by `shift` and rotated by `angle` about `axis` through its own position, all in
 * the frame it maps into.
 * @param {number[]} pose
 * @param {number[]} shift
 * @param {number[]} axis
 * @param {number} angle
 */
export function nudged(pose, shift, axis, angle) {
  const s = Math.sin(angle / 2);
  const length = Math.hypot(...axis) || 1;
  const q = product([...axis.map((a) => (a / length) * s), Math.cos(angle / 2)], pose.slice(3));
  const norm = Math.hypot(...q);
  return [pose[0] + shift[0], pose[1] + shift[1], pose[2] + shift[2], ...q.map((v) => v / norm)];
}

/**
 * How far two poses lie apart: [m, degrees].
 * @param {number[]} a
 * @param {number[]} b
 */
export function apart(a, b) {
  const d = Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  const dot = Math.abs(a[3] * b[3] + a[4] * b[4] + a[5] * b[5] + a[6] * b[6]);
  return [d, (2 * Math.acos(Math.min(1, dot)) * 180) / Math.PI];
}

/** Parallel projection: yaw about the vertical, pitch from level (0) to from above (90°). */
export class Camera {
  yaw = 0;
  pitch = Math.PI / 2;
  scale = 40; // pixels per meter
  center = [0, 0, 0];

  /** Axes of the screen in the upright frame: right, up, and towards the eye. */
  axes() {
    const [cy, sy, cp, sp] = [
      Math.cos(this.yaw),
      Math.sin(this.yaw),
      Math.cos(this.pitch),
      Math.sin(this.pitch),
    ];
    return [
      [cy, sy, 0],
      [-sy * sp, cy * sp, cp],
      [sy * cp, -cy * cp, sp],
    ];
  }

  /**
   * @param {number[]} p
   * @param {number} width
   * @param {number} height
   */
  toScreen(p, width, height) {
    const d = [p[0] - this.center[0], p[1] - this.center[1], p[2] - this.center[2]];
    const [right, up] = this.axes();
    const dot = (/** @type {number[]} */ a) => a[0] * d[0] + a[1] * d[1] + a[2] * d[2];
    return [width / 2 + this.scale * dot(right), height / 2 - this.scale * dot(up)];
  }

  /**
   * Shows nine tenths of the points x y z around the origin in a square of `px` pixels.
   * @param {Float32Array} points
   * @param {number} px
   */
  fit(points, px) {
    if (!points.length) return;
    const distances = [];
    for (let k = 0; k < points.length; k += 30)
      distances.push(Math.hypot(points[k], points[k + 1]));
    distances.sort((a, b) => a - b);
    const reach = Math.max(2, distances[Math.floor(distances.length * 0.9)]);
    this.scale = (0.46 * (px || 400)) / reach;
    this.center = [0, 0, 0];
  }

  /**
   * A step on the screen as a step in the upright frame [m].
   * @param {number} dx
   * @param {number} dy
   */
  step(dx, dy) {
    const [right, up] = this.axes();
    return right.map((r, k) => (r * dx - up[k] * dy) / this.scale);
  }

  /**
   * @param {number} dx
   * @param {number} dy
   */
  pan(dx, dy) {
    const step = this.step(dx, dy);
    this.center = this.center.map((c, k) => c - step[k]);
  }
}
