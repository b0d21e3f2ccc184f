"""M3C2: signed distances between two maps with a level of detection, tile by tile.

D. Lague, N. Brodu, J. Leroux: Accurate 3D comparison of complex topography with terrestrial laser
scanner, ISPRS Journal 82 (2013). For each core point ``i`` of the first map:

1. its normal ``N`` is that of the plane through its neighbors within ``D / 2``;
2. the points of both maps in a cylinder of diameter ``d`` along ``N`` are projected on its axis:
   means ``i1``, ``i2``, standard deviations ``s1``, ``s2``, numbers ``n1``, ``n2``;
3. the distance is ``i2 - i1``, and by equation (1)

       LOD95 = 1.96 ( sqrt(s1² / n1 + s2² / n2) + reg )

``reg`` is the uncertainty of the registration, here that of both maps at this place:
``reg = sqrt(r1² + r2²)`` with the mean of the standard deviations that each map states for its
points. What differs from the paper: points that face away are of the other side of a thin wall and
do not count, and of the points in a cylinder only the layer nearest to the core point does.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.comparison.records import CoreDifferences, CoreState, M3C2Scales
from recon4.comparison.tuning import M3C2
from recon4.geometry.se3 import SE3, Array
from recon4.kernels.cell_table import CellIndex, index_keys
from recon4.kernels.m3c2 import (
    CylinderLimits,
    Layers,
    NearPoints,
    layers,
    normals_at_scale,
    numbers_of_cubes,
    one_of_each_cube,
)
from recon4.kernels.slices import project, select
from recon4.mapping.tile import DEVIATION, Columns
from recon4.mapping.tiles import Tile, TileSet
from recon4.progress import Progress, Silent, track

_Points = tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]
"""Points (N, 3), normals (N, 3), stated standard deviations (N,)."""


@dataclass(frozen=True, slots=True, eq=False)
class TileBox:
    """A part of space along the axes of the first map [m]."""

    low: Array
    high: Array

    @staticmethod
    def of(tile: Tile) -> TileBox:
        """That of a tile's points."""
        return TileBox(np.array(tile.low_m), np.array(tile.high_m))

    def grown(self, by_m: float) -> TileBox:
        """With a margin all around."""
        return TileBox(self.low - by_m, self.high + by_m)

    def meets(self, other: TileBox) -> bool:
        """Whether two have a point in common."""
        return bool(np.all(self.low <= other.high) and np.all(self.high >= other.low))

    def moved(self, T_a_b: SE3) -> TileBox:
        """The box around it after a motion."""
        corners = np.array(np.meshgrid(*zip(self.low, self.high, strict=True))).reshape(3, -1).T
        p = T_a_b @ corners
        return TileBox(p.min(axis=0), p.max(axis=0))


def differences(
    first: TileSet,
    second: TileSet,
    T_a_b: SE3,
    *,
    scales: M3C2Scales,
    progress: Progress | None = None,
) -> Iterator[CoreDifferences]:
    """Compare two maps; yields the core points of each tile of the first.

    Both are taken where they were measured: the noise that fitted surfaces have lost is part of
    the level of detection. In memory are the points around one tile.

    Args:
        first: The map with the core points, ``a``.
        second: The map that is compared with it, ``b``.
        T_a_b: Maps points of the second into the frame of the first.
        scales: Sizes.
        progress: Counts tiles.

    Raises:
        ConfigError: If a size is out of range.
        StoreError: If a map is damaged.
    """
    scales.check()
    ours = MapAround(first.as_measured(), SE3.identity())
    theirs = MapAround(second.as_measured(), T_a_b)
    tiles = ours.tiles.tiles
    for tile in track(tiles, progress or Silent(), what="Compare", unit="tiles"):
        found = _of_tile(tile, ours, theirs, scales=scales)
        if found is not None:
            yield found


def _of_tile(
    tile: Tile, ours: MapAround, theirs: MapAround, *, scales: M3C2Scales
) -> CoreDifferences | None:
    core, facing = core_points(tile, scales.core_spacing_m)
    if not len(core):
        return None
    box = TileBox(core.min(axis=0), core.max(axis=0))
    middle = (box.low + box.high) / 2.0
    radius, scale = scales.cylinder_m / 2.0, scales.normal_m / 2.0
    cell_m = max(radius, scale)
    around = box.grown(max(scale, np.hypot(scales.depth_m, radius)))
    own, other = (one.near(around, middle, cell_m) for one in (ours, theirs))
    p = (core - middle).astype(np.float32)
    normal = np.empty((len(p), 3), np.float32)
    normals_at_scale(p, facing, own, (scale, cell_m, M3C2.min_neighbors), normal)
    layer = [Layers(*np.empty((4, len(p)))) for _ in range(2)]
    # The first map's surface is at the core point itself: no other one is looked for.
    for out, points, farthest_m in zip(layer, (own, other), (0.0, scales.depth_m), strict=True):
        limits = CylinderLimits(
            cell_m, radius, scales.depth_m, scales.layer_m, farthest_m, M3C2.min_points
        )
        layers(p, normal, points, limits, out)
    return _judged(core, normal, ours=layer[0], theirs=layer[1])


def _judged(
    core: Array, normal: NDArray[np.float32], *, ours: Layers, theirs: Layers
) -> CoreDifferences:
    """Distances and levels of detection of layers, equation (1) of the paper."""
    (i1, var1, n1, r1), (i2, var2, n2, r2) = ours, theirs
    distance = i2 - i1
    with np.errstate(divide="ignore", invalid="ignore"):
        lod = M3C2.confidence * (np.sqrt(var1 / n1 + var2 / n2) + np.hypot(r1, r2))
    state = np.where(np.abs(distance) > lod, CoreState.SIGNIFICANT, CoreState.BELOW_LOD)
    state[np.isnan(i2)] = CoreState.WITHOUT_PARTNER
    state[np.isnan(i1)] = CoreState.SPARSE
    state[~np.any(normal != 0.0, axis=1)] = CoreState.WITHOUT_NORMAL
    return CoreDifferences(
        p_map=core,
        normal=normal,
        distance_m=distance.astype(np.float32),
        lod_m=np.where(np.isnan(distance), np.nan, lod).astype(np.float32),
        points=np.stack([n1, n2], axis=1).astype(np.int32),
        state=state.astype(np.uint8),
    )


def core_points(tile: Tile, spacing_m: float) -> tuple[Array, NDArray[np.float32]]:
    """Points of a tile, one in each cube, and their stored normals.

    Args:
        tile: Of the first map.
        spacing_m: Edge of the cubes [m].

    Returns:
        The points [m], (M, 3), and normals towards the sensor, zeros = not known, (M, 3).
    """
    known = "normal" in tile.fields
    columns = tile.read(["xyz", *(["normal"] if known else [])])
    xyz = np.ascontiguousarray(columns["xyz"])
    key = np.empty(len(xyz), np.int64)
    numbers_of_cubes(xyz, spacing_m, key)
    order, chosen = np.argsort(key, kind="stable"), np.empty(len(xyz), np.int64)
    chosen = chosen[: one_of_each_cube(xyz, order, key, spacing_m, chosen)]
    facing = columns["normal"][chosen] if known else np.zeros((len(chosen), 3))
    return xyz[chosen].astype(np.float64) + tile.origin_m, facing.astype(np.float32)


class MapAround:
    """The points of a map around places of the first map, in its frame."""

    def __init__(self, tiles: TileSet, T_a_b: SE3) -> None:
        self.tiles = tiles
        self._T = T_a_b
        self._boxes = [TileBox.of(tile).moved(T_a_b) for tile in tiles]
        self._fields = [name for name in ("xyz", "normal", DEVIATION) if name in tiles.fields]
        self._kept: OrderedDict[int, Columns] = OrderedDict()
        """Of the tiles read last, by row: each is a neighbor of some others."""
        self._bytes = 0

    def near(self, box: TileBox, middle: Array, cell_m: float) -> NearPoints:
        """Points in a box, from its middle, by cubes of this edge."""
        nothing = np.empty((0, 3), np.float32)
        parts: list[_Points] = [(nothing, nothing, nothing[:, 0])]
        for row, own in enumerate(self._boxes):
            if own.meets(box):
                parts.append(self._within(row, box, middle))
        xyz, normal, sd_m = (np.concatenate(columns) for columns in zip(*parts, strict=True))
        return _by_cubes(xyz, normal, sd_m, cell_m=cell_m)

    def _read(self, row: int) -> Columns:
        """Columns of a tile; those read last are kept, within `M3C2.kept_bytes`."""
        if row in self._kept:
            self._kept.move_to_end(row)
            return self._kept[row]
        columns = self.tiles.tiles[row].read(self._fields)
        self._kept[row] = columns
        self._bytes += _size(columns)
        while self._bytes > M3C2.kept_bytes and len(self._kept) > 1:
            self._bytes -= _size(self._kept.popitem(last=False)[1])
        return columns

    def _within(self, row: int, box: TileBox, middle: Array) -> _Points:
        columns, tile = self._read(row), self.tiles.tiles[row]
        xyz, rows = np.ascontiguousarray(columns["xyz"]), np.empty(len(tile), np.int32)
        axes = np.ascontiguousarray(self._T.R)
        shift = self._T.R @ np.array(tile.origin_m) + self._T.t
        rows = rows[: select(xyz, axes, shift, box.low, box.high, rows)]
        p = np.empty((len(rows), 3))
        project(xyz, rows, axes, shift - middle, p)
        normal = np.zeros((len(rows), 3), np.float32)
        if "normal" in columns:
            normal = (columns["normal"][rows].astype(np.float32) @ self._T.R.T).astype(np.float32)
        sd_m = np.full(len(rows), M3C2.usual_sd_m, np.float32)
        if DEVIATION in columns:
            stated = columns[DEVIATION][rows].astype(np.float32)
            sd_m = np.where(np.isfinite(stated), stated, sd_m)
        return p.astype(np.float32), normal, sd_m


def _size(columns: Columns) -> int:
    return sum(values.nbytes for values in columns.values())


def _by_cubes(
    xyz: NDArray[np.float32],
    normal: NDArray[np.float32],
    sd_m: NDArray[np.float32],
    *,
    cell_m: float,
) -> NearPoints:
    key = np.empty(len(xyz), np.int64)
    numbers_of_cubes(xyz, cell_m, key)
    order = np.argsort(key, kind="stable")
    cubes, first = np.unique(key[order], return_index=True)
    slots = np.full(1 << (2 * len(cubes) + 1).bit_length(), -1, np.int32)
    index_keys(cubes, slots)
    ends = np.append(first, len(xyz)).astype(np.int64)
    return NearPoints(xyz[order], normal[order], sd_m[order], ends, CellIndex(cubes, slots))
