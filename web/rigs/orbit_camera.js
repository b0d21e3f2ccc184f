// Orthographic camera that orbits a point; x forward, y left, z up. No DOM.

const START = { yaw: 0.65, pitch: 0.45 };
const LIMIT = Math.PI / 2;
const MARGIN = 0.92;

export class OrbitCamera {
  yaw = START.yaw;
  pitch = START.pitch;
  middle = [0, 0, 0];
  pxPerM = 500;
  #fitted = 500;

  /** Looks at a sphere from the start direction, with all of it in a window of `size` pixels. */
  reset(
    /** @type {{middle: number[], radius: number}} */ { middle, radius },
    /** @type {number[]} */ [width, height],
  ) {
    Object.assign(this, START);
    this.fit({ middle, radius }, [width, height]);
  }

  /** Fits a sphere into a window and keeps the direction. */
  fit(
    /** @type {{middle: number[], radius: number}} */ { middle, radius },
    /** @type {number[]} */ [width, height],
  ) {
    this.middle = middle;
    this.pxPerM = this.#fitted = (MARGIN * Math.min(width, height)) / (2 * radius);
  }

  /**
   * @param {number} dx
   * @param {number} dy
   */
  orbit(dx, dy) {
    this.yaw -= dx * 0.008;
    this.pitch = Math.min(Math.max(this.pitch + dy * 0.008, -LIMIT), LIMIT);
  }

  zoom(/** @type {number} */ factor) {
    const fitted = this.#fitted;
    this.pxPerM = Math.min(Math.max(this.pxPerM * factor, fitted / 4), fitted * 10);
  }

  /** [right, down] in pixels from the middle of the window, and the depth toward the viewer. */
  project(/** @type {number[]} */ [x, y, z]) {
    const [a, b, c] = [x - this.middle[0], y - this.middle[1], z - this.middle[2]];
    const [cy, sy] = [Math.cos(this.yaw), Math.sin(this.yaw)];
    const [cp, sp] = [Math.cos(this.pitch), Math.sin(this.pitch)];
    const toward = cy * a + sy * b;
    const right = -sy * a + cy * b;
    const up = cp * c - sp * toward;
    return [right * this.pxPerM, -up * this.pxPerM, cp * toward + sp * c];
  }
}
