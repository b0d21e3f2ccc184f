"""How crisp a map is without any truth: mean map entropy and plane thickness.

Mean map entropy: Droeschel, Behnke 2014, Razlaw et al. 2015, with a ball of 0.3 m. Both figures
depend on how dense a map is, so it is first thinned to one point a voxel; compare only figures
made with the same radius and voxel.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from recon4.evaluation.tuning import SHARPNESS
from recon4.geometry.cubes import cube_keys, cubes_of
from recon4.geometry.distinct import distinct
from recon4.geometry.se3 import Array


@dataclass(frozen=True, slots=True)
class Sharpness:
    """Crispness of a map; smaller is crisper."""

    entropy: float
    """Mean of ``ln |2 pi e S| / 2`` over the places [nats]; NaN = no place has neighbors."""
    plane_thickness_m: float
    """Median standard deviation of the points across planar places [m]; NaN = none is planar."""
    places: int
    """Places with enough neighbors."""
    planar_places: int
    radius_m: float
    voxel_m: float


def sharpness(
    points: Array,
    *,
    places: Array,
    radius_m: float = 0.3,
    voxel_m: float = 0.02,
) -> Sharpness:
    """Mean map entropy and plane thickness at some places.

    Args:
        points: Points of the map around the places, or all of it [m], (N, 3).
        places: Where to look, see `draw_places` [m], (M, 3).
        radius_m: Neighbors of a place are the points in a ball of this radius [m].
        voxel_m: One point is kept in a cube of this size before anything else [m].
    """
    p = thin([points], voxel_m=voxel_m)
    if not len(p) or not len(places):
        return Sharpness(float("nan"), float("nan"), 0, 0, radius_m, voxel_m)
    where, tree = places, cKDTree(p)
    parts = [
        _covariances(tree, where[k : k + SHARPNESS.batch], radius_m)
        for k in range(0, len(where), SHARPNESS.batch)
    ]
    eigenvalues = np.linalg.eigvalsh(np.concatenate(parts))
    usable = eigenvalues[:, 0] > 1e-12
    variance = eigenvalues[usable]
    entropy = 0.5 * np.log((2.0 * np.pi * np.e) ** 3 * variance.prod(axis=1))
    planar = (variance[:, 0] < SHARPNESS.planar * variance[:, 1]) & (
        variance[:, 1] > SHARPNESS.planar * variance[:, 2]
    )
    return Sharpness(
        entropy=_or_nan(np.mean, entropy),
        plane_thickness_m=_or_nan(np.median, np.sqrt(variance[planar, 0])),
        places=len(variance),
        planar_places=int(planar.sum()),
        radius_m=radius_m,
        voxel_m=voxel_m,
    )


def draw_places(chunks: Iterable[Array], *, rng: np.random.Generator, count: int = 2000) -> Array:
    """Points of the map drawn at random, spread evenly over its surfaces, (<= count, 3).

    Args:
        chunks: Points of the map [m], arrays of (N, 3).
        rng: Source of randomness.
        count: How many.
    """
    spread = thin(chunks, voxel_m=0.25)
    return spread[np.sort(rng.choice(len(spread), size=min(count, len(spread)), replace=False))]


def around(places: Array, chunks: Iterable[Array], *, radius_m: float) -> Iterator[Array]:
    """Of every chunk the points that may lie within a radius of a place: few of a large map.

    Args:
        places: Where to look [m], (M, 3), M > 0.
        chunks: Points of the map [m], arrays of (N, 3).
        radius_m: Radius [m]; every point within it is kept, and some beyond.
    """
    shifts = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3), axis=-1).reshape(-1, 3)
    cells = np.floor(places / radius_m).astype(np.int64)[:, None] + shifts
    wanted = distinct(_key(cells.reshape(-1, 3)))
    for chunk in chunks:
        p = np.asarray(chunk, dtype=np.float64)
        key = _key(np.floor(p / radius_m).astype(np.int64))
        found = np.minimum(np.searchsorted(wanted, key), len(wanted) - 1)
        yield p[wanted[found] == key]


def _key(cell: NDArray[np.int64]) -> NDArray[np.int64]:
    """One number a cell; exact within a million cells of the origin."""
    i, j, k = (cell + (1 << 20)).T
    return (((i << 21) | j) << 21) | k


def thin(chunks: Iterable[Array], *, voxel_m: float) -> Array:
    """The first point in every voxel, in the order they come, (M, 3).

    Args:
        chunks: Points [m], arrays of (N, 3).
        voxel_m: Edge of the voxels [m].
    """
    kept: Array = np.empty((0, 3))
    waiting: list[Array] = []
    points = 0
    for chunk in chunks:
        part = np.asarray(chunk, dtype=np.float64)
        waiting.append(part[_first_in_voxel(part, voxel_m)])
        points += len(waiting[-1])
        if points > max(len(kept), SHARPNESS.merge_points):
            kept = _merged(kept, waiting, voxel_m)
            waiting, points = [], 0
    return _merged(kept, waiting, voxel_m)


def _merged(kept: Array, more: list[Array], voxel_m: float) -> Array:
    both = np.concatenate([kept, *more])
    return both[_first_in_voxel(both, voxel_m)]


def _first_in_voxel(p: Array, voxel_m: float) -> NDArray[np.intp]:
    return np.sort(np.unique(cube_keys(cubes_of(p, voxel_m)), return_index=True)[1])


def _covariances(tree: cKDTree, where: Array, radius_m: float) -> Array:
    """Sample covariances of the neighbors of each place that has enough, (<= M, 3, 3) [m²]."""
    lists = tree.query_ball_point(where, radius_m)
    counts = np.array([len(rows) for rows in lists])
    enough = counts >= SHARPNESS.min_neighbors
    if not enough.any():
        return np.empty((0, 3, 3))
    rows = np.concatenate([lists[k] for k in np.flatnonzero(enough)]).astype(np.intp)
    n = counts[enough]
    start = np.concatenate([[0], np.cumsum(n)[:-1]])
    d = tree.data[rows] - np.repeat(where[enough], n, axis=0)
    mean = np.add.reduceat(d, start) / n[:, None]
    square = np.add.reduceat(d[:, :, None] * d[:, None, :], start)
    return (square - n[:, None, None] * mean[:, :, None] * mean[:, None, :]) / (n - 1)[
        :, None, None
    ]


def _or_nan(statistic: object, values: Array) -> float:
    assert callable(statistic)
    return float(statistic(values)) if len(values) else float("nan")
