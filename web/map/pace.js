// How many points a computer draws at once: ruled by how long its frames take. No DOM, no network.

const SLOW_MS = 170;
const QUICK_MS = 80;
const FEWEST = 100_000;
const ENOUGH = 400_000; // from here on pixels count more than points
const BLURRED = 0.4; // smallest part of the pixels in width and height
const LEAST_AT_REST = 1_200_000;
const MOST = 4_000_000;
const AT_REST = 6; // frames of refining after the camera has stopped

export class Pace {
  /** Points of a frame while the camera moves. */
  moving = 300_000;
  /** Part of the pixels in width and height that are drawn while it moves. */
  sharpness = 1;

  /**
   * A frame of the moving camera was drawn. What is slow loses pixels first, then points.
   * @param {number} points
   * @param {number} ms
   */
  note(points, ms) {
    const [slow, quick] = [ms > SLOW_MS, ms < QUICK_MS];
    if (slow && this.sharpness > BLURRED) this.sharpness = Math.max(BLURRED, 0.7 * this.sharpness);
    else if (slow) this.#set((points || this.moving) * Math.max(0.7, SLOW_MS / ms));
    else if (quick && points > 0.7 * this.moving && this.moving < ENOUGH)
      this.#set(1.3 * this.moving);
    else if (quick && this.sharpness < 1) this.sharpness = Math.min(1, 1.2 * this.sharpness);
    else if (quick && points > 0.7 * this.moving) this.#set(1.3 * this.moving);
  }

  /** Points of all frames at rest: as many as are drawn within about two seconds. */
  get resting() {
    return Math.min(MOST, Math.max(LEAST_AT_REST, AT_REST * this.moving));
  }

  #set(/** @type {number} */ points) {
    this.moving = Math.round(Math.min(MOST, Math.max(FEWEST, points)));
  }
}
