// The points of the map: what has been read of each tile, and its objects in the scene.

import { dot, minus } from "./camera.js";
import { apartOf } from "./density.js";
import { isOutside, nextPart, readingOrder, takeParts } from "./lod.js";
import {
  BufferAttribute,
  BufferGeometry,
  Points,
} from "../shared/vendor/three/three.module.min.js";

/**
 * @import {MapIndex} from "../shared/http_types"
 * @import {Camera, Ray} from "./camera.js"
 * @import {Material, Matrix4, Scene} from "../shared/vendor/three/three.module.min.js"
 * @typedef {"xyz" | "intensity" | "normalized" | "time" | "uncertainty" | "thickness"} Stored
 * @typedef {{start: number, stop: number}} Part
 * @typedef {object} Reader
 * @property {(stored: Stored) => Promise<ArrayBuffer>} sample
 * @property {(stored: Stored, parts: Array<{tile: number} & Part>) => Promise<ArrayBuffer>} parts
 *   one after the other
 * @typedef {object} Chunk
 * @property {number} start
 * @property {number} stop
 * @property {Uint16Array} places
 * @property {Points} object
 * @property {string} valuesOf what its values are of; empty = none have been read
 * @typedef {object} Look what the shader is given for the points of a chunk
 * @property {number} thinned how much farther apart neighbors are than if all were drawn
 * @property {boolean} known
 */

const MOST_POINTS = 6_000_000; // kept; of more, those that are not shown go
const AT_ONCE = 3;

export class MapTiles {
  #index;
  #scene;
  #material;
  #reader;
  #onLook;
  #move;
  /** @type {Chunk[][]} */
  #chunks;
  /** @type {Set<number>} tiles of which something is read */
  #reading = new Set();
  #requests = 0;
  /** @type {{counts: number[], camera: Camera} | null} */
  #wanted = null;
  /** @type {Camera | null} */
  #refused = null; // until it moves: a server that refuses is not asked on and on
  #begun = false; // parts follow the sample: read beside it, they would overlap it
  /** @type {Stored | ""} */
  #values = "";
  total = 0;
  onNews = () => {};
  /** @type {(problem: unknown) => void} */
  onProblem = () => {};

  /**
   * @param {MapIndex} index
   * @param {{scene: Scene, material: Material, reader: Reader, onLook: (look: Look) => void,
   *   move?: Matrix4}} into `move` maps its points into the scene
   */
  constructor(index, { scene, material, reader, onLook, move }) {
    this.#move = move;
    this.#index = index;
    this.#scene = scene;
    this.#material = material;
    this.#reader = reader;
    this.#onLook = onLook;
    this.#chunks = index.tiles.map(() => []);
  }

  /** Points that have been read of each tile. */
  get have() {
    return this.#chunks.map((chunks) => chunks.at(-1)?.stop ?? 0);
  }

  /** Whether all that is wanted has been read. */
  get complete() {
    const have = this.have;
    return !this.#reading.size && (this.#wanted?.counts.every((n, k) => n <= have[k]) ?? true);
  }

  /** Reads the sample of the whole map. */
  async readSample(/** @type {Stored | ""} */ values) {
    this.#values = values;
    try {
      const [places, steps] = await Promise.all([
        this.#reader.sample("xyz"),
        values ? this.#reader.sample(values) : null,
      ]);
      let [at, from] = [0, 0];
      this.#index.tiles.forEach(({ sample }, k) => {
        if (!sample) return;
        this.#add(k, { start: 0, stop: sample }, places.slice(at, (at += 10 * sample)));
        if (steps) this.#fill(this.#chunks[k][0], values, steps.slice(from, (from += 2 * sample)));
      });
    } finally {
      this.#begun = true;
    }
    this.onNews();
    this.#readOn();
  }

  /**
   * Which points are wanted: the count of each tile.
   * @param {number[]} counts
   * @param {Camera} camera
   */
  want(counts, camera) {
    if (camera === this.#refused) return;
    this.#refused = null;
    this.#wanted = { counts, camera };
    this.#readOn();
  }

  /** Colors by other values: reads those of all points that have been read. */
  async color(/** @type {Stored | ""} */ values) {
    this.#values = values;
    if (!values) return;
    const steps = await this.#reader.sample(values);
    if (this.#values !== values) return;
    let from = 0;
    this.#index.tiles.forEach(({ sample }, k) => {
      if (!sample) return;
      const [first] = this.#chunks[k];
      if (first?.stop === sample) this.#fill(first, values, steps.slice(from, from + 2 * sample));
      from += 2 * sample;
    });
    this.onNews();
    this.#readOn();
  }

  /**
   * Sets which points are drawn: the count of each tile, if they have been read.
   * @param {number[]} counts
   * @returns {Array<{object: Points, points: number}>} nearest tiles last
   */
  show(counts) {
    /** @type {Array<{object: Points, points: number}>} */
    const drawn = [];
    this.#chunks.forEach((chunks, k) => {
      const have = Math.min(counts[k], chunks.at(-1)?.stop ?? 0);
      const thinned = Math.sqrt(this.#index.tiles[k].points / Math.max(have, 1));
      for (const { start, stop, object, valuesOf } of chunks) {
        const shown = Math.min(stop, have) - start;
        object.visible = shown > 0;
        if (shown <= 0) continue;
        object.geometry.setDrawRange(0, shown);
        const known = valuesOf === this.#values;
        object.onBeforeRender = () => this.#onLook({ thinned, known });
        drawn.push({ object, points: shown });
      }
    });
    return drawn;
  }

  /**
   * Distance along a ray to the first point that was read within a cone about it; null = none.
   * @param {Ray} ray
   * @param {{tan: number, least: number, planes: number[][]}} cone
   */
  along({ origin, direction }, { tan, least, planes }) {
    let nearest = Infinity;
    this.#index.tiles.forEach((tile, k) => {
      if (isOutside(tile, planes) || !this.#chunks[k].length) return;
      const middle = tile.low_m.map((low, axis) => (low + tile.high_m[axis]) / 2);
      const radius = Math.hypot(...minus(tile.high_m, tile.low_m)) / 2;
      const to = minus(middle, origin);
      const depth = dot(to, direction);
      const beside = Math.sqrt(Math.max(0, dot(to, to) - depth * depth));
      if (beside > radius + tan * (depth + radius) + least) return;
      if (depth - radius > nearest) return;
      for (const chunk of this.#chunks[k])
        nearest = Math.min(nearest, along(chunk.places, tile, { origin, direction }));
    });
    return Number.isFinite(nearest) ? nearest : null;

    /**
     * @param {Uint16Array} places
     * @param {{low_m: number[], high_m: number[]}} tile
     * @param {Ray} ray
     */
    function along(places, { low_m, high_m }, ray) {
      const scale = [0, 1, 2].map((axis) => (high_m[axis] - low_m[axis]) / 65535);
      const shift = minus(low_m, ray.origin);
      const [dx, dy, dz] = ray.direction;
      let best = Infinity;
      for (let k = 0; k < places.length; k += 3) {
        const x = places[k] * scale[0] + shift[0];
        const y = places[k + 1] * scale[1] + shift[1];
        const z = places[k + 2] * scale[2] + shift[2];
        const depth = x * dx + y * dy + z * dz;
        if (depth < 0.02 || depth > best) continue;
        const beside = x * x + y * y + z * z - depth * depth;
        const most = tan * depth + least;
        if (beside > most * most) continue;
        const [px, py, pz] = [x + ray.origin[0], y + ray.origin[1], z + ray.origin[2]];
        if (planes.every(([a, b, c, d]) => a * px + b * py + c * pz + d >= 0)) best = depth;
      }
      return best;
    }
  }

  #readOn() {
    if (!this.#wanted || !this.#begun) return;
    const { counts, camera } = this.#wanted;
    const { tiles } = this.#index;
    const have = this.have;
    const order = readingOrder(tiles, { counts, have }, camera);
    const queue = order
      .filter((k) => !this.#reading.has(k))
      .flatMap((tile) => {
        const part = nextPart(have[tile], counts[tile], tiles[tile].points);
        return part ? [{ tile, ...part }] : [];
      });
    while (queue.length && this.#requests < AT_ONCE) this.#readParts(takeParts(queue));
    if (!order.length && !this.#reading.size) this.#readValues();
  }

  async #readParts(/** @type {Array<{tile: number} & Part>} */ parts) {
    const values = this.#values;
    await this.#read(parts, async () => {
      const [places, steps] = await Promise.all([
        this.#reader.parts("xyz", parts),
        values ? this.#reader.parts(values, parts) : null,
      ]);
      let [at, from] = [0, 0];
      for (const { tile, start, stop } of parts) {
        const count = stop - start;
        const [place, step] = [at, from];
        [at, from] = [at + 10 * count, from + 2 * count];
        const chunks = this.#chunks[tile];
        if ((chunks.at(-1)?.stop ?? 0) !== start) continue; // forgotten meanwhile
        this.#add(tile, { start, stop }, places.slice(place, at));
        const chunk = chunks.at(-1);
        if (steps && chunk) this.#fill(chunk, values, steps.slice(step, from));
      }
      this.#dropUnseen();
    });
  }

  /** Reads values of what was read before another color was chosen. */
  #readValues() {
    const values = this.#values;
    if (!values) return;
    const missing = this.#chunks.flatMap((chunks, tile) => {
      const chunk = chunks.find((one) => one.valuesOf !== values);
      return chunk ? [{ tile, chunk, start: chunk.start, stop: chunk.stop }] : [];
    });
    while (missing.length && this.#requests < AT_ONCE)
      this.#readValuesOf(values, takeParts(missing));
  }

  /**
   * @param {Stored} values
   * @param {Array<{tile: number, chunk: Chunk} & Part>} parts
   */
  async #readValuesOf(values, parts) {
    await this.#read(parts, async () => {
      const steps = await this.#reader.parts(values, parts);
      let from = 0;
      for (const { chunk, start, stop } of parts)
        this.#fill(chunk, values, steps.slice(from, (from += 2 * (stop - start))));
    });
  }

  /**
   * @param {Array<{tile: number}>} parts
   * @param {() => Promise<void>} read
   */
  async #read(parts, read) {
    for (const { tile } of parts) this.#reading.add(tile);
    this.#requests++;
    try {
      await read();
    } catch (problem) {
      this.#refused = this.#wanted?.camera ?? this.#refused;
      this.#wanted = null;
      this.onProblem(problem);
    } finally {
      this.#requests--;
      for (const { tile } of parts) this.#reading.delete(tile);
    }
    this.onNews();
    this.#readOn();
  }

  /**
   * @param {number} k
   * @param {Part} part
   * @param {ArrayBuffer} data
   */
  #add(k, { start, stop }, data) {
    const count = stop - start;
    const places = new Uint16Array(data, 0, 3 * count);
    const about = new Int8Array(data, 6 * count, 4 * count);
    const geometry = new BufferGeometry();
    geometry.setAttribute("place", new BufferAttribute(places, 3, true));
    geometry.setAttribute("about", new BufferAttribute(about, 4, true));
    const tile = this.#index.tiles[k];
    geometry.setAttribute("apart", new BufferAttribute(apartOf(places, tile), 1, true));
    const object = new Points(geometry, this.#material);
    const { low_m: low, high_m: high } = tile;
    const [x, y, z] = minus(high, low);
    object.matrixWorld.set(x, 0, 0, low[0], 0, y, 0, low[1], 0, 0, z, low[2], 0, 0, 0, 1);
    if (this.#move) object.matrixWorld.premultiply(this.#move);
    Object.assign(object, {
      matrixAutoUpdate: false,
      matrixWorldAutoUpdate: false,
      frustumCulled: false,
      visible: false,
    });
    this.#scene.add(object);
    this.#chunks[k].push({ start, stop, places, object, valuesOf: "" });
    this.total += count;
  }

  /**
   * @param {Chunk} chunk
   * @param {Stored | ""} values
   * @param {ArrayBuffer} steps
   */
  #fill(chunk, values, steps) {
    chunk.object.geometry.setAttribute(
      "value",
      new BufferAttribute(new Uint16Array(steps), 1, true),
    );
    chunk.valuesOf = values;
  }

  /** Forgets points that are not shown, the finest ones of each tile first. */
  #dropUnseen() {
    const counts = this.#wanted?.counts;
    for (const [k, chunks] of this.#chunks.entries())
      while (this.total > MOST_POINTS && chunks.length > 1) {
        const last = /** @type {Chunk} */ (chunks.at(-1));
        if (counts && last.start < counts[k]) break;
        chunks.pop();
        this.#scene.remove(last.object);
        last.object.geometry.dispose();
        this.total -= last.stop - last.start;
      }
  }
}
