// How far apart the points of a map are, place by place: they are drawn as large. No DOM.

const WANTED = 10; // points of a part in a cell, on the average
const MOST_CELLS = 40; // along an edge of a tile
const FARTHER = 3; // than usual in the tile: lonely points stay small
const FINEST_M = 0.001;
const OCTAVES = 12;

/**
 * Distance of neighbors at each point if all points of its tile were drawn, as the shader reads it:
 * octaves above a millimeter, 0 to 12 in a byte. Points of a tile are an even sample of it, so
 * those of a part are counted in cells.
 * @param {Uint16Array} places x, y, z of each point as fractions of the tile
 * @param {{low_m: number[], high_m: number[], points: number, spacing_m: number}} tile
 */
export function apartOf(places, { low_m, high_m, points, spacing_m }) {
  const count = places.length / 3;
  const edges = [0, 1, 2].map((axis) => Math.max(high_m[axis] - low_m[axis], 1e-3));
  const cell = cellOf(edges, count, spacing_m * Math.sqrt(points / Math.max(count, 1)));
  const sizes = edges.map((edge) => Math.floor(edge / cell) + 1);
  const scale = edges.map((edge) => edge / cell / 65536);
  const counts = new Uint32Array(sizes[0] * sizes[1] * sizes[2]);
  const cells = new Uint32Array(count);
  for (let k = 0; k < count; k++) {
    const x = (places[3 * k] * scale[0]) | 0;
    const y = (places[3 * k + 1] * scale[1]) | 0;
    const z = (places[3 * k + 2] * scale[2]) | 0;
    cells[k] = x + sizes[0] * (y + sizes[1] * z);
    counts[cells[k]]++;
  }
  const parts = points / Math.max(count, 1);
  const bytes = new Map();
  const byteOf = (/** @type {number} */ many) => {
    const apart = cell / Math.sqrt(many * parts);
    const bounded = Math.min(Math.max(apart, spacing_m * 0.8), spacing_m * FARTHER);
    const octaves = Math.log2(Math.max(bounded, FINEST_M) / FINEST_M);
    return Math.min(255, Math.round((255 * octaves) / OCTAVES));
  };
  return Uint8Array.from(cells, (at) => {
    const many = counts[at];
    if (!bytes.has(many)) bytes.set(many, byteOf(many));
    return bytes.get(many);
  });
}

/**
 * Edge of cells that hold the wanted number of points on a surface [m].
 * @param {number[]} edges of the tile
 * @param {number} count
 * @param {number} apart usual distance of the part's points
 */
function cellOf(edges, count, apart) {
  const longest = Math.max(...edges);
  const wanted = apart * Math.sqrt(WANTED);
  return count ? Math.min(longest, Math.max(wanted, longest / MOST_CELLS)) : longest;
}
