"""What stands in a map: its ground, large flat surfaces, and what grows.

Returns are counted in cells while the map is made; `docs/explanation/map.md` explains what the
cells say of the points.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels import ground_cells, structure_cells
from recon4.kernels.cell_table import (
    KEY,
    CellIndex,
    CellSums,
    add_returns,
    index_keys,
    move_sums,
)
from recon4.kernels.structure_cells import NEAR, CubePlanes
from recon4.kernels.structure_points import Structure, StructureCodes, classify_points
from recon4.mapping.structure_tuning import GROUND, GROWTH, PLANES, POINTS, STRUCTURE
from recon4.mapping.undistort import Placed
from recon4.model.classes import PointClass

CODES = StructureCodes(
    int(PointClass.GROUND),
    int(PointClass.LOW_VEGETATION),
    int(PointClass.MEDIUM_VEGETATION),
    int(PointClass.HIGH_VEGETATION),
    int(PointClass.BUILDING),
)


class StructureCells:
    """Counts returns in cells; memory is that of the surfaces that were seen, up to a limit."""

    def __init__(self, *, most: int = STRUCTURE.most) -> None:
        """There are no returns yet.

        Args:
            most: Cells that are kept; what is seen first in further ones has no such class.
        """
        self._most, self._used = most, 0
        self._sums = _empty_sums(STRUCTURE.first)

    @property
    def is_full(self) -> bool:
        """Whether there may be returns without a cell."""
        return self._used == self._most

    def add(self, placed: Placed, chosen: NDArray[np.bool_], echo: NDArray[np.uint8]) -> None:
        """Count some of the returns of a multiframe.

        Args:
            placed: They and their sensors.
            chosen: Which of them stand, (N,).
            echo: Number of the echo of its beam, (N,).
        """
        while self._used + len(echo) > STRUCTURE.filled * len(self._sums.key):
            if STRUCTURE.filled * len(self._sums.key) > self._most:
                break
            larger = _empty_sums(2 * len(self._sums.key))
            move_sums(self._sums, larger)
            self._sums = larger
        cell_m, limits = (GROUND.cell_m, GROUND.height_m), (STRUCTURE.range_m, self._most)
        xyz, origin = placed.xyz_m, placed.origin_m
        self._used = add_returns(xyz, origin, chosen, echo, cell_m, limits, self._sums, self._used)

    def structure(self, walk_m: Array) -> Structure | None:
        """What stands there; forgets the returns.

        Args:
            walk_m: Positions of the body in the map, (W, 3).

        Returns:
            None where no ground is found below the walk.
        """
        key, sums = self._taken()
        cells, count = indexed(key), sums[:, 0].astype(np.float64)
        means = sums[:, 1:4] / count[:, None]
        means += _numbers(cells.key) * [GROUND.cell_m, GROUND.cell_m, GROUND.height_m]
        above = (sums[:, 4] / count).astype(np.float32)
        cubes, of_cell, of_cubes = _cubes(cells, means, sums)
        del sums, count
        planes = _planes(cubes, of_cubes)
        steep = planes.normal.any(axis=1) & (np.abs(planes.normal[:, 2]) < STRUCTURE.steep)
        above[steep[of_cell]] = 0.0
        ground = _ground(cells, means, above, walk_m=np.ascontiguousarray(walk_m, np.float64))
        if not ground.any():
            return None
        planes.flat[of_cell[ground]] = False
        below, below_m = _below(means[ground])
        near, growth = _things(cubes, planes, of_cubes[:, 3], ground=(below, below_m))
        return Structure(
            indexed(cells.key[ground]),
            means[ground, 2].astype(np.float32),
            below,
            below_m,
            cubes,
            planes.normal,
            planes.offset,
            near,
            growth,
        )

    def _taken(self) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """Keys in ascending order (C,) and sums (C, 6) of what was counted; the table is freed."""
        (key, total), self._sums = self._sums, _empty_sums(STRUCTURE.first)
        self._used = 0
        rows = np.flatnonzero((key >= 0) & (total[:, 0] >= STRUCTURE.least))
        rows = rows[np.argsort(key[rows])]
        return key[rows], total[rows]


def mark_structure(
    classes: NDArray[np.uint8],
    xyz: NDArray[np.float32],
    origin_m: Array,
    *,
    normals: tuple[NDArray[np.float32], NDArray[np.int32]],
    structure: Structure,
) -> None:
    """Mark ground, buildings and vegetation among the points of a tile.

    Args:
        classes: Of all points; those of unclassified ones may change, (N,).
        xyz: From the tile's origin [m], (N, 3).
        origin_m: Of the tile in the map, (3,).
        normals: Towards the sensor, zeros = none, (K, 3) or more columns, and the row of each
            point, (N,).
        structure: What stands in the map.
    """
    open_ = int(PointClass.UNCLASSIFIED)
    classify_points(xyz, origin_m, normals, structure, POINTS, CODES, open_, classes)


def indexed(key: NDArray[np.int64]) -> CellIndex:
    """Index of cells by keys in ascending order, (C,)."""
    slots = np.full(1 << (2 * len(key) + 1).bit_length(), -1, np.int32)
    index_keys(key, slots)
    return CellIndex(key, slots)


def _empty_sums(places: int) -> CellSums:
    return CellSums(np.full(places, -1, np.int64), np.zeros((places, 6), np.float32))


def _numbers(key: NDArray[np.int64]) -> NDArray[np.int64]:
    """Numbers of cells by their keys, (C, 3)."""
    mask = (1 << KEY.each) - 1
    parts = [(key >> shift) & mask for shift in (2 * KEY.each, KEY.each, 0)]
    return np.stack(parts, axis=1) - KEY.zero


def _keys(numbers: NDArray[np.int64]) -> NDArray[np.int64]:
    """Keys of cells by their numbers (C, 3)."""
    i, j, k = (numbers + KEY.zero).T
    return np.asarray((i << (2 * KEY.each)) | (j << KEY.each) | k)


def _ground(
    cells: CellIndex, means: Array, above: NDArray[np.float32], *, walk_m: Array
) -> NDArray[np.bool_]:
    """Which cells are ground: those that lead on from below the walk, (C,)."""
    level, ground = np.empty((2, len(means)), np.bool_)
    ground[:] = False
    ground_cells.find_level(cells, above, GROUND, level)
    below = np.empty(len(walk_m), np.int64)
    ground_cells.find_below(cells, level, walk_m, GROUND, below)
    over_m = walk_m[below >= 0, 2] - means[below[below >= 0], 2]
    if not len(over_m):
        return ground
    carried = np.abs(over_m - np.median(over_m)) <= GROUND.same_m
    ground[below[below >= 0][carried]] = True
    queue = np.empty(len(means), np.int32)
    ground_cells.grow_ground(cells, means, level, GROUND, ground, queue)
    return ground


def _below(ground_m: Array) -> tuple[CellIndex, NDArray[np.float32]]:
    """Heights of the ground in cubes of one meter, spread to those around [m]."""
    keys, heights = _mean_of(_keys(np.floor(ground_m).astype(np.int64)), ground_m[:, 2])
    fresh, fresh_m = keys, heights
    for _ in range(STRUCTURE.spread):
        spread = np.concatenate(list(_beside(fresh)))
        new, new_m = _mean_of(spread, np.tile(fresh_m, 4))
        # Not above or below ground that is there: floors of other storeys are farther.
        known = np.zeros(len(new), np.bool_)
        for k in range(-STRUCTURE.storey, STRUCTURE.storey + 1):
            known |= np.isin(new + k, keys)
        fresh, fresh_m = new[~known], new_m[~known]
        keys, heights = np.concatenate([keys, fresh]), np.concatenate([heights, fresh_m])
    order = np.argsort(keys)
    return indexed(keys[order]), heights[order].astype(np.float32)


def _beside(keys: NDArray[np.int64]) -> Iterator[NDArray[np.int64]]:
    for step in (1 << 2 * KEY.each, 1 << KEY.each):
        yield keys - step
        yield keys + step


def _mean_of(keys: NDArray[np.int64], values: Array) -> tuple[NDArray[np.int64], Array]:
    """Each key once, with the mean of its values."""
    found, of = np.unique(keys, return_inverse=True)
    return found, np.bincount(of, values, len(found)) / np.bincount(of, minlength=len(found))


def _cubes(
    cells: CellIndex, means: Array, sums: NDArray[np.float32]
) -> tuple[CellIndex, NDArray[np.intp], Array]:
    """Cubes of the cells, that of each, and of each the means x, y, z, and the parts that were
    seen from above and of echoes, (C, 5).
    """
    numbers = _numbers(cells.key)
    numbers[:, 2] //= STRUCTURE.layers
    keys, of = np.unique(_keys(numbers), return_inverse=True)
    weight = np.bincount(of, sums[:, 0], len(keys))
    parts = [*(means.T * sums[:, 0]), sums[:, 4], sums[:, 5]]
    totals = np.stack([np.bincount(of, part, len(keys)) for part in parts], axis=1)
    return indexed(keys), of, totals / weight[:, None]


def _planes(cubes: CellIndex, of_cubes: Array) -> CubePlanes:
    n = len(of_cubes)
    planes = CubePlanes(
        np.ascontiguousarray(of_cubes[:, :3]),
        np.empty((n, 3), np.float32),
        np.empty(n),
        np.empty(n, np.bool_),
        np.empty(n, np.bool_),
        of_cubes[:, 4].astype(np.float32),
    )
    structure_cells.fit_cubes(cubes, planes, PLANES)
    return planes


def _things(
    cubes: CellIndex,
    planes: CubePlanes,
    above: Array,
    *,
    ground: tuple[CellIndex, NDArray[np.float32]],
) -> tuple[NDArray[np.int32], NDArray[np.bool_]]:
    """Planes of buildings near each cube, and which cubes are vegetation."""
    n = len(above)
    surface, queue = np.empty((2, n), np.int32)
    count = structure_cells.number_surfaces(cubes, planes, PLANES, surface, queue)
    ceiling = np.abs(planes.normal[:, 2]) >= STRUCTURE.level
    ceiling &= above < GROUND.seen_above
    over_m = np.empty(n, np.float32)
    ground_cells.heights_over(*ground, planes.mean, ceiling, POINTS.down, over_m)
    building, round_ = _large(surface, count, planes, over_m=over_m)
    structure_cells.extend_surfaces(cubes, planes, PLANES, building, queue)
    near = np.empty((n, NEAR.planes), np.int32)
    structure_cells.near_planes(cubes, planes, building, PLANES, near)
    roof = building & ceiling & (over_m >= STRUCTURE.roof_m)
    open_ = ~building & (over_m >= STRUCTURE.bare_m) & ~_covered(cubes.key, roof)
    growth = np.empty(n, np.bool_)
    structure_cells.find_growth(cubes, _irregular(planes, round_), open_, GROWTH, growth)
    return near, growth


def _irregular(planes: CubePlanes, round_: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cubes without the planes of things that were built, (C,)."""
    tilt, planar = np.abs(planes.normal[:, 2]), planes.normal.any(axis=1)
    tilted = planar & (tilt >= STRUCTURE.tilt[0]) & (tilt <= STRUCTURE.tilt[1])
    loose = ~planar & ~planes.line
    return np.asarray(round_ | tilted | loose | (planes.echoes >= STRUCTURE.echoes))


def _large(
    surface: NDArray[np.int32], count: int, planes: CubePlanes, *, over_m: NDArray[np.float32]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Cubes of large surfaces: of those of buildings, which are high, and of round ones, (C,)."""
    mine = surface >= 0
    over, top, bottom = np.full((3, count + 1), -np.inf)
    known, z_m = mine & np.isfinite(over_m), planes.mean[:, 2]
    np.maximum.at(over, surface[known], over_m[known])
    np.maximum.at(top, surface[mine], z_m[mine])
    np.maximum.at(bottom, surface[mine], -z_m[mine])
    cubes = np.bincount(surface[mine], minlength=count + 1)
    n, spread = planes.normal[mine], np.empty((count + 1, 3, 3))
    for a in range(3):
        for b in range(3):
            spread[:, a, b] = np.bincount(surface[mine], n[:, a] * n[:, b], count + 1)
    bend = np.linalg.eigvalsh(spread / np.maximum(cubes, 1)[:, None, None])
    slant = spread[:, 2, 2] / np.maximum(cubes, 1)
    upright, level = slant <= STRUCTURE.upright**2, slant >= STRUCTURE.flat_level
    high = (over >= STRUCTURE.roof_m) | (upright & (top + bottom >= STRUCTURE.tall_m))
    large, aligned = cubes >= STRUCTURE.cubes, upright | level
    round_ = bend[:, 0] > STRUCTURE.round_
    flat = (bend[:, 1] <= STRUCTURE.round_) | (bend[:, 0] <= STRUCTURE.folded)
    built = high & np.where(aligned, ~round_, flat)
    return mine & (large & built)[surface], mine & (large & round_)[surface]


def _covered(keys: NDArray[np.int64], roof: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which cubes have a ceiling over their square meter or one beside it, (C,)."""
    cells = np.unique(keys[roof] >> KEY.each << KEY.each)  # one of each column
    under, count = np.unique(_keys(_flat(cells)), return_counts=True)
    under = under[count >= STRUCTURE.roofed * STRUCTURE.per_meter**2]
    covered = _wide(under)
    for _ in range(STRUCTURE.eaves):
        covered = np.unique(np.concatenate([covered, *_beside(covered)]))
    return np.isin(_keys(_flat(keys)), covered)


def _wide(keys: NDArray[np.int64]) -> NDArray[np.int64]:
    """Square meters with enough others around: no balconies."""
    reach, count = STRUCTURE.around, np.zeros(len(keys), np.int64)
    for i in range(-reach, reach + 1):
        for j in range(-reach, reach + 1):
            count += np.isin(keys + (i << 2 * KEY.each) + (j << KEY.each), keys)
    return keys[count >= STRUCTURE.wide]


def _flat(keys: NDArray[np.int64]) -> NDArray[np.int64]:
    """Numbers of the square meter of each cube, (C, 3)."""
    place = _numbers(keys) // STRUCTURE.per_meter
    place[:, 2] = 0
    return place
