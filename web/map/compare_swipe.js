// Another map on the other side of a divider: its points in a scene of their own.

import { define, giveLook, pointMaterial } from "./materials.js";
import { nodesOf } from "./nodes.js";
import { MapTiles } from "./tiles.js";
import { Matrix4, Scene, Vector2 } from "../shared/vendor/three/three.module.min.js";

/**
 * @import {MapIndex} from "../shared/http_types"
 * @import {Reader} from "./tiles.js"
 * @import {Points, RawShaderMaterial} from "../shared/vendor/three/three.module.min.js"
 */

/**
 * Boxes of tiles after a rigid motion.
 * @param {MapIndex["tiles"]} tiles
 * @param {number[][]} T 4 x 4, row by row
 */
const movedBoxes = (tiles, T) =>
  tiles.map((tile) => {
    const ends = [0, 1, 2].map((row) => {
      let [low, high] = [T[row][3], T[row][3]];
      for (let axis = 0; axis < 3; axis++) {
        const both = [T[row][axis] * tile.low_m[axis], T[row][axis] * tile.high_m[axis]];
        low += Math.min(...both);
        high += Math.max(...both);
      }
      return [low, high];
    });
    const [low_m, high_m] = [0, 1].map((end) => ends.map((axis) => axis[end]));
    return { ...tile, low_m, high_m };
  });

/** Points of another map, drawn as those of this one. */
export class MapBeside {
  #rotation;
  #index;
  #material = pointMaterial();
  scene = new Scene();
  nodes;
  tiles;
  /** Where the divider is, as a part of the width: the other map is to its right. */
  part = 0.5;

  /**
   * @param {MapIndex} index
   * @param {Reader} reader
   * @param {number[][]} T maps its points into this map, 4 x 4, row by row
   */
  constructor(index, reader, T) {
    this.#index = index;
    this.#rotation = T.slice(0, 3).map((row) => row.slice(0, 3));
    this.nodes = nodesOf(movedBoxes(index.tiles, T));
    this.scene.matrixWorldAutoUpdate = false;
    const move = new Matrix4().set(...T.flat());
    this.tiles = new MapTiles(index, {
      scene: this.scene,
      material: this.#material,
      reader,
      move,
      onLook: (look) => giveLook(this.#material, look),
    });
  }

  /**
   * Takes the colors, the camera and the clip of this map, and the shape of its points.
   * @param {RawShaderMaterial} material its own
   * @param {{color: string, ends: [number, number]}} drawing
   */
  follow({ uniforms: of, defines }, { color, ends }) {
    define(this.#material, "DISCS", "DISCS" in defines);
    const { uniforms } = this.#material;
    const { thinned, known, turn } = uniforms;
    Object.assign(uniforms, of, { thinned, known, turn });
    const column = this.#index.columns.find(({ name }) => name === color);
    const own = column ? ends.map((x) => (x - column.offset) / column.scale / 65535) : ends;
    uniforms.ends = { value: new Vector2(...own) };
    // Columns of the rotation from this map to the eye, times that from the other map to this one.
    turn.value = [0, 1, 2].flatMap((column) =>
      [0, 1, 2].map((row) =>
        [0, 1, 2].reduce(
          (sum, k) => sum + of.turn.value[3 * k + row] * this.#rotation[k][column],
          0,
        ),
      ),
    );
    this.#material.uniformsNeedUpdate = true;
  }

  /** Colors by the same values, if this map has them. */
  color(/** @type {import("./tiles.js").Stored | ""} */ values) {
    return this.tiles.color(this.#has(values) ? values : "");
  }

  /** Reads the sample. */
  begin(/** @type {import("./tiles.js").Stored | ""} */ values) {
    return this.tiles.readSample(this.#has(values) ? values : "");
  }

  dispose() {
    for (const { geometry } of /** @type {Points[]} */ (/** @type {any} */ (this.scene).children))
      geometry.dispose();
    this.#material.dispose();
  }

  #has(/** @type {string} */ values) {
    return this.#index.columns.some(({ name }) => name === values);
  }
}
