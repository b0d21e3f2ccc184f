"""Connected clusters of the points of a class, with what tells them apart: their evidence.

Tile after tile is read: memory follows the cells of one class, not the points of the map.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.classes.tuning import LIKENESS
from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.kernels.cell_table import KEY
from recon4.kernels.cluster_rays import count_passes
from recon4.locales.coded import CodedText
from recon4.mapping.cell_runs import cell_keys, cell_numbers
from recon4.mapping.class_corrections import ClassVolumes
from recon4.mapping.structure import indexed
from recon4.mapping.tiles import Tile, TileSet
from recon4.model.classes import PointClass

Keys = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class ClassCells:
    """Cells with points of one class, and the ground below."""

    key: Keys
    """Ascending, (C,)."""
    points: Keys
    """In each cell, (C,)."""
    ground: Keys
    """Keys of cells of `LIKENESS.ground_m` with ground, ascending, (G,)."""
    ground_m: Array
    """Mean height of the ground in each of them [m], (G,)."""


@dataclass(frozen=True, slots=True, eq=False)
class ClusterEvidence:
    """What is known of each cluster, (K,) each unless said otherwise."""

    points: Keys
    cells: Keys
    low_m: Array
    high_m: Array
    """Bounds along the axes of the map [m], (K, 3)."""
    long_m: Array
    wide_m: Array
    """Extents along and across its longer level direction [m]."""
    over_ground_m: Array
    """From the ground below to its lowest cell [m]; NaN = there is no ground below."""
    planarity: Array
    """(√λ₂ - √λ₃) / √λ₁ of its cells, 0 to 1 (Demantké et al. 2011, Eq. 1)."""
    seen_through: Array
    """Part of the beams that pass through it, of those that meet it or pass; NaN = unknown."""

    @property
    def high(self) -> Array:
        """Height from its lowest to its highest cell [m]."""
        return np.asarray(self.high_m[:, 2] - self.low_m[:, 2])


def cells_of_class(tiles: TileSet, code: int, pending: ClassVolumes) -> ClassCells:
    """Cells with points of a class.

    Args:
        tiles: The map.
        code: Of the class; points of it that the map leaves out count, too.
        pending: Corrections that are not in the map yet.

    Raises:
        ConfigError: If the class is all over a large map.
    """
    key, points, ground = (np.empty(0, np.int64) for _ in range(3))
    sums = np.empty((2, 0))
    for p_map, classes in _parts(tiles, pending):
        new, count = np.unique(keys_at(p_map[classes == code], LIKENESS.cell_m), return_counts=True)
        key, of = np.unique(np.concatenate([key, new]), return_inverse=True)
        points = np.bincount(of, np.concatenate([points, count]), len(key)).astype(np.int64)
        if len(key) > LIKENESS.most_cells:
            raise ConfigError(CodedText("like-too-many-cells"))
        earth = p_map[classes == int(PointClass.GROUND)]
        ground, of = np.unique(
            np.concatenate([ground, keys_at(earth, LIKENESS.ground_m)]), return_inverse=True
        )
        more = np.stack([np.ones(len(earth)), earth[:, 2]])
        sums = np.stack(
            [np.bincount(of, row, len(ground)) for row in np.concatenate([sums, more], axis=1)]
        )
    return ClassCells(key, points, ground, sums[1] / np.maximum(sums[0], 1.0))


def connected(key: Keys) -> NDArray[np.int32]:
    """Cluster of each cell: those that touch, also by a corner, belong together, (C,) -> (C,)."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    rows, others = [], []
    for step in _steps():
        at = np.minimum(np.searchsorted(key, key + step), max(len(key) - 1, 0))
        hit = np.flatnonzero(key[at] == key + step)
        rows.append(hit)
        others.append(at[hit])
    pairs = np.concatenate(rows), np.concatenate(others)
    links = coo_array((np.ones(len(pairs[0]), np.bool_), pairs), (len(key), len(key)))
    return np.asarray(connected_components(links, directed=False)[1], np.int32)


def evidence(tiles: TileSet, cells: ClassCells, cluster: NDArray[np.int32]) -> ClusterEvidence:
    """What is known of clusters.

    Args:
        tiles: The map.
        cells: Of a class.
        cluster: Of each cell, 0 to K - 1, (C,).
    """
    number = cell_numbers(cells.key)
    many = int(cluster.max(initial=-1)) + 1
    count = np.bincount(cluster, minlength=many)
    low, high = np.full((many, 3), np.iinfo(np.int64).max), np.full((many, 3), -(1 << 62))
    np.minimum.at(low, cluster, number)
    np.maximum.at(high, cluster, number)
    spread = _spread((number - low[cluster]).astype(np.float64), cluster, count)
    roots = np.sqrt(np.maximum(np.linalg.eigvalsh(spread)[:, ::-1], 0.0))
    level = np.linalg.eigvalsh(spread[:, :2, :2])[:, ::-1]
    # Of cells spread evenly along a line of n: variance (n² - 1) / 12.
    extents = np.sqrt(12.0 * np.maximum(level, 0.0) + 1.0) * LIKENESS.cell_m
    return ClusterEvidence(
        np.bincount(cluster, cells.points, many).astype(np.int64),
        count,
        low * LIKENESS.cell_m + LIKENESS.shift_m,
        (high + 1) * LIKENESS.cell_m + LIKENESS.shift_m,
        extents[:, 0],
        extents[:, 1],
        _over_ground(number, cluster, low * LIKENESS.cell_m, cells=cells),
        (roots[:, 1] - roots[:, 2]) / np.maximum(roots[:, 0], 1e-9),
        _seen_through(tiles, cells.key, cluster),
    )


def _parts(tiles: TileSet, pending: ClassVolumes) -> Iterator[tuple[Array, NDArray[np.uint8]]]:
    """Places and classes of all points, block by block, with what the map leaves out."""
    for tile in (*tiles, *tiles.only_strays()):
        for start in range(0, len(tile), LIKENESS.block):
            rows = slice(start, min(start + LIKENESS.block, len(tile)))
            columns = tile.read(["xyz", "classification"], rows=rows)
            p_map = columns["xyz"].astype(np.float64) + tile.origin_m
            classes = columns["classification"].copy()
            pending.apply(classes, p_map)
            yield p_map, classes


def keys_at(p_map: Array, cell_m: float) -> Keys:
    """Keys of the cells of points in the map [m], (N, 3) -> (N,)."""
    return cell_keys(np.floor((p_map - LIKENESS.shift_m) / cell_m).astype(np.int64))


def _steps() -> Sequence[int]:
    """Differences of keys to half of the 26 cells around; the others follow by symmetry."""
    every = ((i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1))
    return [(i << 2 * KEY.each) + (j << KEY.each) + k for i, j, k in every if (i, j, k) > (0, 0, 0)]


def _spread(number: Array, cluster: NDArray[np.int32], count: Keys) -> Array:
    """Covariance of the cells of each cluster [cells²], (K, 3, 3)."""
    many, weight = len(count), np.maximum(count, 1)[:, None]
    mean = np.stack([np.bincount(cluster, number[:, a], many) for a in range(3)], axis=1) / weight
    away, spread = number - mean[cluster], np.empty((many, 3, 3))
    for a in range(3):
        for b in range(3):
            spread[:, a, b] = np.bincount(cluster, away[:, a] * away[:, b], many) / weight[:, 0]
    return spread


def _over_ground(
    number: Keys, cluster: NDArray[np.int32], low_m: Array, *, cells: ClassCells
) -> Array:
    """From the highest ground under each cluster to its lowest cell [m], (K,)."""
    ground, edge_m = cells.ground, LIKENESS.ground_m
    over = np.full(len(low_m), np.nan)
    if not len(ground):
        return over
    foot = number // round(edge_m / LIKENESS.cell_m)
    foot[:, 2] = np.floor(low_m[:, 2] / edge_m).astype(np.int64)[cluster] + 1
    key, of = np.unique(np.stack([cell_keys(foot), cluster]), axis=1)
    # The ground of the same column that is nearest below: keys ascend with the height last.
    at = np.searchsorted(ground, key, side="right") - 1
    below = np.maximum(at, 0)
    same = (at >= 0) & (ground[below] >> KEY.each == key >> KEY.each)
    top = np.full(len(low_m), -np.inf)
    np.maximum.at(top, of[same], cells.ground_m[below[same]])
    known = np.isfinite(top)
    over[known] = low_m[known, 2] - top[known]
    return over


def _seen_through(tiles: TileSet, key: Keys, cluster: NDArray[np.int32]) -> Array:
    """Part of the beams of an even sample that pass through each cluster, (K,)."""
    paths, many = tiles.columns.paths, int(cluster.max(initial=-1)) + 1
    if not paths.known or not {"t_ns", "sensor"} <= set(tiles.fields):
        return np.full(many, np.nan)
    counts, index = np.zeros((many, 2), np.int64), indexed(key)
    rules = (LIKENESS.cell_m, LIKENESS.margin_m, LIKENESS.farthest_m)
    part = min(1.0, LIKENESS.beams / max(tiles.points + tiles.strays, 1))
    for tile in (*tiles, *tiles.only_strays()):
        end, origin = _beams(tile, part)
        count_passes(origin, end, index, cluster, rules, counts)
    total = counts.sum(axis=1)
    return np.where(total >= LIKENESS.least_beams, counts[:, 0] / np.maximum(total, 1), np.nan)


def _beams(tile: Tile, part: float) -> tuple[Array, Array]:
    """Ends and origins of an even sample of the beams of a tile [m], (N, 3) each."""
    some = tile.read(["xyz", "t_ns", "sensor"], limit=int(np.ceil(part * len(tile))))
    end = some["xyz"].astype(np.float64) + tile.origin_m - LIKENESS.shift_m
    origin = tile.columns.paths.at(some["t_ns"], some["sensor"]) - LIKENESS.shift_m
    return end, np.ascontiguousarray(origin)
