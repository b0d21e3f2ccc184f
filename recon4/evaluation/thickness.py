"""Thickness of the planar surfaces of a map, as a whole and by place; needs no ground truth.

Thickness alone can be made small by keeping only what is flat, so the planar coverage is always
beside it.
"""

from __future__ import annotations

from math import ceil

import numpy as np

from recon4.evaluation.tuning import THICKNESS
from recon4.geometry.cubes import cube_keys, cubes_of
from recon4.geometry.se3 import Array
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
    cell = cubes_of(p, THICKNESS.cell_m)
    key = cube_keys(cell)
    n = np.bincount(key)
    used = np.flatnonzero(n >= THICKNESS.min_points)
    local = p - (cell + 0.5) * THICKNESS.cell_m  # small numbers: sums of squares keep their digits
    local -= local.mean(axis=0)
    first = np.stack([np.bincount(key, local[:, i])[used] for i in range(3)], axis=1)
    second = np.empty((len(used), 3, 3))
    for i in range(3):
        for j in range(i, 3):
            second[:, i, j] = second[:, j, i] = np.bincount(key, local[:, i] * local[:, j])[used]
    count = n[used, None]
    mean = first / count
    covariance = second / count[:, :, None] - mean[:, :, None] * mean[:, None, :]
    covariance *= (count / (count - 1.0))[:, :, None]
    return np.asarray(np.linalg.eigvalsh(covariance), dtype=np.float64)
