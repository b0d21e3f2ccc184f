"""Read the points of a map with numpy, tile by tile.

A map may be larger than the memory, so it lies on the disk in cubes. A tile gives coordinates in
the map as float64, and columns by name: intensities, time, sensor, ring, …
"""

import numpy as np

from recon4 import api


def main() -> None:
    """Print what is in the map, and find the height of its floor."""
    tiles = api.read_tiles("walk")
    low, high = tiles.bounds_m
    print(f"{len(tiles)} points in {len(tiles.tiles)} tiles of {tiles.tile_m:.0f} m")
    print("size", np.round(high - low, 1).tolist(), "m; columns", ", ".join(tiles.fields))

    heights = np.arange(np.floor(low[2]), np.ceil(high[2]) + 0.05, 0.05)
    count = np.zeros(len(heights) - 1, dtype=np.int64)
    for tile in tiles:
        count += np.histogram(tile.xyz_m()[:, 2], bins=heights)[0]
    lower = heights[:-1] < low[2] + 1.0
    print(f"floor at z = {heights[:-1][lower][count[lower].argmax()] + 0.025:.2f} m")

    sample = [tile.read(["intensity_normalized"], limit=1000) for tile in tiles]
    values = np.concatenate([columns["intensity_normalized"] for columns in sample])
    print(f"median of the normalized intensities: {np.median(values):.2f}")


if __name__ == "__main__":
    main()
