// The points of the map: what has been read of each node, and its objects in the scene.

import { dot, minus } from "./camera.js";
import { apartOf } from "./density.js";
import { isOutside, nextPart, readingOrder, takeParts } from "./lod.js";
import { nodesOf, thinnedOf } from "./nodes.js";
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
 * @typedef {Part & {node: number, row: number, ofCube: boolean}} Wanted the row is that of the
 *   index; it counts points of a tile that are in its cube, too
 * @typedef {object} Reader
 * @property {(stored: Stored) => Promise<ArrayBuffer>} sample
 * @property {(stored: Stored, parts: Wanted[]) => Promise<ArrayBuffer>} parts one after the other,
 *   all of cubes or all of tiles
 * @typedef {object} Chunk
 * @property {number} start
 * @property {number} stop
 * @property {Uint16Array} places
 * @property {Points} object
 * @property {string} valuesOf what its values are of; empty = none have been read
 * @property {Look} look
 * @typedef {object} Look what the shader is given for the points of a chunk
 * @property {number[]} thinned how much farther apart neighbors are than if all were drawn: at
 *   the tile, or at each tile of the cube
 * @property {boolean} known
 */

/** Bytes a point. */
const bytesOf = (/** @type {boolean} */ ofCube) => (ofCube ? 11 : 10);
const MOST_POINTS = 6_000_000; // kept; of more, those that are not shown go
const AT_ONCE = 3;

export class MapTiles {
  nodes;
  #scene;
  #material;
  #reader;
  #onLook;
  #move;
  /** @type {Chunk[][]} */
  #chunks;
  /** @type {Set<number>} nodes of which something is read */
  #reading = new Set();
  #requests = 0;
  /** @type {{counts: number[], camera: Camera} | null} */
  #wanted = null;
  /** @type {Camera | null} */
  #refused = null; // until it moves: a server that refuses is not asked on and on
  begun = false; // parts follow the sample: read beside it, they would overlap it
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
    this.nodes = nodesOf(index.tiles);
    this.#scene = scene;
    this.#material = material;
    this.#reader = reader;
    this.#onLook = onLook;
    this.#chunks = this.nodes.map(() => []);
  }

  /** Asks again for what was refused. */
  again() {
    this.#refused = null;
    this.onNews();
  }

  /** Points that have been read of each node. */
  get have() {
    return this.#chunks.map((chunks) => chunks.at(-1)?.stop ?? 0);
  }

  /** Whether something is being read. */
  get reads() {
    return this.#requests > 0;
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
      this.nodes.forEach(({ sample }, k) => {
        if (!sample) return;
        this.#add(k, { start: 0, stop: sample }, places.slice(at, (at += bytesOf(true) * sample)));
        if (steps) this.#fill(this.#chunks[k][0], values, steps.slice(from, (from += 2 * sample)));
      });
    } finally {
      this.begun = true;
    }
    this.onNews();
    this.#readOn();
  }

  /**
   * Which points are wanted: the count of each node.
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
    this.nodes.forEach(({ sample }, k) => {
      if (!sample) return;
      const [first] = this.#chunks[k];
      if (first?.stop === sample) this.#fill(first, values, steps.slice(from, from + 2 * sample));
      from += 2 * sample;
    });
    this.onNews();
    this.#readOn();
  }

  /**
   * Sets which points are drawn: the count of each node, if they have been read.
   * @param {number[]} counts
   * @returns {Array<{object: Points, points: number}>}
   */
  show(counts) {
    /** @type {Array<{object: Points, points: number}>} */
    const drawn = [];
    const have = this.have.map((points, k) => Math.min(counts[k], points));
    this.#chunks.forEach((chunks, k) => {
      const thinned = have[k] ? thinnedOf(this.nodes, k, (node) => have[node]) : [];
      for (const chunk of chunks) {
        const { start, stop, object, valuesOf } = chunk;
        const shown = Math.min(stop, have[k]) - start;
        object.visible = shown > 0;
        if (shown <= 0) continue;
        object.geometry.setDrawRange(0, shown);
        chunk.look = { thinned, known: valuesOf === this.#values };
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
    this.nodes.forEach((node, k) => {
      if (isOutside(node, planes) || !this.#chunks[k].length) return;
      const middle = node.low_m.map((low, axis) => (low + node.high_m[axis]) / 2);
      const radius = Math.hypot(...minus(node.high_m, node.low_m)) / 2;
      const to = minus(middle, origin);
      const depth = dot(to, direction);
      const beside = Math.sqrt(Math.max(0, dot(to, to) - depth * depth));
      if (beside > radius + tan * (depth + radius) + least) return;
      if (depth - radius > nearest) return;
      for (const chunk of this.#chunks[k])
        nearest = Math.min(nearest, along(chunk.places, node, { origin, direction }));
    });
    return Number.isFinite(nearest) ? nearest : null;

    /**
     * @param {Uint16Array} places
     * @param {{low_m: number[], high_m: number[]}} node
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
    if (!this.#wanted || !this.begun) return;
    const { counts, camera } = this.#wanted;
    const have = this.have;
    const order = readingOrder(this.nodes, { counts, have }, camera);
    const queue = order
      .filter((k) => !this.#reading.has(k))
      .flatMap((k) => {
        const part = nextPart(have[k], counts[k], this.nodes[k].points);
        return part ? [this.#wantedOf(k, part)] : [];
      });
    while (queue.length && this.#requests < AT_ONCE) this.#readParts(takeParts(queue));
    if (!order.length && !this.#reading.size) this.#readValues();
  }

  /**
   * @param {number} node
   * @param {Part} part
   * @returns {Wanted}
   */
  #wantedOf(node, { start, stop }) {
    const { cube, row } = this.nodes[node];
    return { start, stop, node, ofCube: cube < 0, row };
  }

  /** Parts as they are requested. */
  #rowsOf(/** @type {Wanted[]} */ parts) {
    return parts.map((part) => {
      const { before } = this.nodes[part.node];
      return { ...part, start: part.start + before, stop: part.stop + before };
    });
  }

  async #readParts(/** @type {Wanted[]} */ parts) {
    const values = this.#values;
    await this.#read(parts, async () => {
      const [places, steps] = await Promise.all([
        this.#reader.parts("xyz", this.#rowsOf(parts)),
        values ? this.#reader.parts(values, this.#rowsOf(parts)) : null,
      ]);
      let [at, from] = [0, 0];
      for (const { node, ofCube, start, stop } of parts) {
        const count = stop - start;
        const [place, step] = [at, from];
        [at, from] = [at + bytesOf(ofCube) * count, from + 2 * count];
        const chunks = this.#chunks[node];
        if ((chunks.at(-1)?.stop ?? 0) !== start) continue; // forgotten meanwhile
        this.#add(node, { start, stop }, places.slice(place, at));
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
    const missing = this.#chunks.flatMap((chunks, node) => {
      const chunk = chunks.find((one) => one.valuesOf !== values);
      return chunk ? [{ ...this.#wantedOf(node, chunk), chunk }] : [];
    });
    while (missing.length && this.#requests < AT_ONCE)
      this.#readValuesOf(values, takeParts(missing));
  }

  /**
   * @param {Stored} values
   * @param {Array<{chunk: Chunk} & Wanted>} parts
   */
  async #readValuesOf(values, parts) {
    await this.#read(parts, async () => {
      const steps = await this.#reader.parts(values, this.#rowsOf(parts));
      let from = 0;
      for (const { chunk, start, stop } of parts)
        this.#fill(chunk, values, steps.slice(from, (from += 2 * (stop - start))));
    });
  }

  /**
   * @param {Wanted[]} parts
   * @param {() => Promise<void>} read
   */
  async #read(parts, read) {
    for (const { node } of parts) this.#reading.add(node);
    this.#requests++;
    try {
      await read();
    } catch (problem) {
      this.#refused = this.#wanted?.camera ?? this.#refused;
      this.#wanted = null;
      this.onProblem(problem);
    } finally {
      this.#requests--;
      for (const { node } of parts) this.#reading.delete(node);
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
    const node = this.nodes[k];
    const apart = apartOf(places, { ...node, points: node.whole });
    geometry.setAttribute("apart", new BufferAttribute(apart, 1, true));
    if (node.cube < 0) {
      const slots = new Uint8Array(data, 10 * count, count);
      geometry.setAttribute("slot", new BufferAttribute(slots, 1));
    }
    const object = new Points(geometry, this.#material);
    const { low_m: low, high_m: high } = node;
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
    const look = { thinned: [], known: false };
    const chunk = { start, stop, places, object, valuesOf: "", look };
    object.onBeforeRender = () => this.#onLook(chunk.look);
    this.#chunks[k].push(chunk);
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

  /** Forgets points that are not shown, the finest ones of each node first; never the sample. */
  #dropUnseen() {
    const counts = this.#wanted?.counts;
    for (const [k, chunks] of this.#chunks.entries())
      while (this.total > MOST_POINTS && chunks.length > Math.sign(this.nodes[k].sample)) {
        const last = /** @type {Chunk} */ (chunks.at(-1));
        if (counts && last.start < counts[k]) break;
        chunks.pop();
        this.#scene.remove(last.object);
        last.object.geometry.dispose();
        this.total -= last.stop - last.start;
      }
  }
}
