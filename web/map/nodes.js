// The nodes of what is drawn: cubes with the coarse points of up to 64 tiles, then the tiles with
// the rest of their points. No DOM, no network.

/**
 * @import {MapTile} from "../shared/http_types"
 * @typedef {Omit<MapTile, "low_m" | "high_m"> & {low_m: number[], high_m: number[]}} Tile
 * @typedef {object} MapNode
 * @property {number[]} low_m
 * @property {number[]} high_m
 * @property {number} points of its own
 * @property {number} before points of a tile that are in its cube
 * @property {number} whole points of the node and of what is below or above it: of its tiles
 * @property {number} sample points that are always drawn if it is seen
 * @property {number} spacing_m of neighbors if all are drawn
 * @property {number} cube row of the node that has the coarse points of a tile; -1 = it is a cube
 * @property {number[]} tiles the nodes of the tiles of a cube, in their order
 * @property {number} row of the cube or of the tile in the index
 */

/**
 * The cubes, then the tiles.
 * @param {Tile[]} tiles
 * @returns {MapNode[]}
 */
export function nodesOf(tiles) {
  const count = tiles.reduce((most, { cube }) => Math.max(most, cube + 1), 0);
  /** @type {number[][]} */
  const rows = Array.from({ length: count }, () => []);
  tiles.forEach(({ cube }, row) => rows[cube].push(row));
  return [
    ...rows.map((own, row) => ({
      ...cubeOf(own.map((one) => tiles[one])),
      tiles: own.map((one) => count + one),
      row,
    })),
    ...tiles.map(({ low_m, high_m, points, coarse, spacing_m, cube }, row) => ({
      ...{ low_m, high_m, spacing_m, cube, row },
      points: points - coarse,
      before: coarse,
      whole: points,
      sample: 0,
      tiles: [],
    })),
  ];
}

/** What a cube is by its tiles. */
function cubeOf(/** @type {Tile[]} */ some) {
  const sum = (/** @type {(tile: Tile) => number} */ of) =>
    some.reduce((all, tile) => all + of(tile), 0);
  const whole = sum(({ points }) => points);
  const area_m2 = sum(({ points, spacing_m }) => points * spacing_m ** 2);
  return {
    low_m: [0, 1, 2].map((k) => Math.min(...some.map(({ low_m }) => low_m[k]))),
    high_m: [0, 1, 2].map((k) => Math.max(...some.map(({ high_m }) => high_m[k]))),
    points: sum(({ coarse }) => coarse),
    before: 0,
    whole,
    sample: sum(({ sample }) => sample),
    spacing_m: Math.sqrt(area_m2 / Math.max(whole, 1)),
    cube: -1,
  };
}

/**
 * How much farther apart neighbors are than if all points were drawn, at each tile of a node: a
 * list for cubes, which have points of several tiles, beside which finer ones may be drawn.
 * @param {MapNode[]} nodes
 * @param {number} k
 * @param {(node: number) => number} shown points of a node that are drawn
 */
export function thinnedOf(nodes, k, shown) {
  const node = nodes[k];
  const cube = nodes[node.cube < 0 ? k : node.cube];
  const part = shown(node.cube < 0 ? k : node.cube) / Math.max(cube.points, 1);
  const at = (/** @type {number} */ tile) => {
    const { whole, before } = nodes[tile];
    return Math.sqrt(whole / Math.max(part * before + shown(tile), 1));
  };
  return node.cube < 0 ? node.tiles.map(at) : [at(k)];
}
