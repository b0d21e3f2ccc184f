"""How large the surfaces are that the points of tiles lie on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.first_view.tuning import FIRST_VIEW
from recon4.geometry.se3 import Array
from recon4.mapping.tiles import TileSet


def sides_m2(tiles: TileSet) -> Array:
    """Surface of the box around the points of each tile [m²], (T,)."""
    low, high = (
        np.array([getattr(tile, name) for tile in tiles], np.float64).reshape(-1, 3)
        for name in ("low_m", "high_m")
    )
    x, y, z = (high - low).T
    return np.asarray(2.0 * (x * y + y * z + z * x))


def cells_m2(tiles: TileSet) -> Array:
    """Surface of the cells in which each tile has one point, none beyond its box [m²], (T,)."""
    apart_m = tiles.notes.voxel_m or FIRST_VIEW.surface_m
    counts = np.array([len(tile) for tile in tiles], dtype=np.float64)
    return np.asarray(np.minimum(counts * apart_m**2, sides_m2(tiles) + apart_m**2))


def surfaces_m2(p_map: Array, sizes: NDArray[np.int64], least_m2: Array) -> Array:
    """Surface that the points of each tile lie on [m²], (T,).

    Of evenly spread points the nearest one is at half the root of the surface that each has, on
    the average (Clark and Evans 1954, eq. 1). Tiles with few points are as the median of others.

    Args:
        p_map: Even samples of the tiles, one after the other [m], (N, 3).
        sizes: Points of each, (T,).
        least_m2: Smallest surface of each, that of the cells in which a map has one point, (T,).
    """
    from scipy.spatial import cKDTree  # only where maps are read, not where a server starts

    ratio, ends = np.full(len(sizes), np.nan), np.cumsum(sizes)
    for row in np.flatnonzero(sizes >= FIRST_VIEW.spread_points).tolist():
        part = p_map[ends[row] - sizes[row] : ends[row]]
        away_m = cKDTree(part).query(part, k=2)[0][:, 1]
        ratio[row] = len(part) * (2.0 * away_m.mean()) ** 2 / max(least_m2[row], 1e-9)
    known = ratio[np.isfinite(ratio)]
    usual = float(np.median(known)) if len(known) else 1.0
    return np.asarray(least_m2 * np.maximum(np.where(np.isfinite(ratio), ratio, usual), 1.0))
