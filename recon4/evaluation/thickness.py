"""Thickness of the planar surfaces of a map, as a whole and by place; needs no ground truth.

Thickness alone can be made small by keeping only what is flat, so the planar coverage is always
beside it.
"""

from __future__ import annotations

from math import ceil

import numpy as np

from recon4.evaluation.tuning import THICKNESS
from recon4.geometry.se3 import Array
from recon4.kernels.cube_sums import add_to_cubes, sort_into_cubes
from recon4.kernels.normals import bounds
from recon4.mapping.tiles import TileSet
from recon4.model.figures import PlaceThickness, PlaneThickness


def plane_thickness(tiles: TileSet) -> PlaneThickness:
    """Standard deviation of the points across the planar ones of all cubes of 30 cm.

    Args:
        tiles: The map; it is read tile by tile.
    """
    used = min(1.0, THICKNESS.most_points / max(1, len(tiles)))
    found: list[Array] = []
    places: list[PlaceThickness] = []
    cells = 0
    for tile in tiles:
        variance = _variances(tile.xyz_m(limit=ceil(used * len(tile))))
        planar = (variance[:, 0] < THICKNESS.planar * variance[:, 1]) & (
            variance[:, 1] > THICKNESS.planar * variance[:, 2]
        )
        thickness = np.sqrt(np.maximum(variance[planar, 0], 0.0))
        cells += len(variance)
        found.append(thickness)
        if len(thickness) >= THICKNESS.min_cells:
            x, y, z = (np.array(tile.low_m) + np.array(tile.high_m)) / 2.0
            share = len(thickness) / len(variance)
            middle = (round(float(x), 2), round(float(y), 2), round(float(z), 2))
            places.append(PlaceThickness(middle, float(np.median(thickness)), share))
    every = np.concatenate(found or [np.empty(0)])
    p50, p95 = np.percentile(every, [50, 95]).tolist() if len(every) else (None, None)
    places.sort(key=lambda place: (-place.p50_m, place.middle_m))
    return PlaneThickness(
        p50_m=p50,
        p95_m=p95,
        planar_coverage=len(every) / cells if cells else None,
        thickest=tuple(places[: THICKNESS.places]),
    )


def _variances(p: Array) -> Array:
    """Eigenvalues of the covariances of the cubes with enough points, ascending, (C, 3) [m²]."""
    if not len(p):
        return np.empty((0, 3))
    low, high = np.empty((2, 3))
    bounds(p, low, high)
    grid = np.floor(np.stack([low, high]) / THICKNESS.cell_m).astype(np.int64)
    grid[1] -= grid[0] - 1
    local_m, key = np.empty_like(p), np.empty(len(p), np.int64)
    n = np.zeros(int(grid[1].prod()), np.int64)
    sort_into_cubes(p, THICKNESS.cell_m, grid, local_m, key, n)
    used = np.flatnonzero(n >= THICKNESS.min_points)
    row = np.full(len(n), -1, np.int32)
    row[used] = np.arange(len(used))
    sums = np.zeros((len(used), 9))
    # Small numbers: sums of squares keep their digits.
    add_to_cubes(local_m, local_m.mean(axis=0), row, key, sums)
    first, second = sums[:, :3], sums[:, [[3, 4, 5], [4, 6, 7], [5, 7, 8]]]
    count = n[used, None]
    mean = first / count
    covariance = second / count[:, :, None] - mean[:, :, None] * mean[:, None, :]
    covariance *= (count / (count - 1.0))[:, :, None]
    return np.asarray(np.linalg.eigvalsh(covariance), dtype=np.float64)
