"""What stands in a map: its ground, large flat surfaces, and what grows.

Returns are counted in cells while the map is made; `docs/explanation/map.md` explains what the
cells say of the points.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels import ground_cells, structure_cells
from recon4.kernels.cell_table import KEY, CellIndex, index_keys
from recon4.kernels.structure_cells import NEAR, CubePlanes
from recon4.kernels.structure_points import Structure, StructureCodes, classify_points
from recon4.mapping.cell_runs import (
    CellRuns,
    MergedCells,
    cell_keys,
    cell_numbers,
    coordinate_sums,
)
from recon4.mapping.structure_tuning import GROUND, GROWTH, PLANES, POINTS, STRUCTURE
from recon4.model.classes import PointClass

CODES = StructureCodes(
    int(PointClass.GROUND),
    int(PointClass.LOW_VEGETATION),
    int(PointClass.MEDIUM_VEGETATION),
    int(PointClass.HIGH_VEGETATION),
    int(PointClass.BUILDING),
)


class StructureCells(NamedTuple):
    """Cells with returns, and the cubes that they make up."""

    cells: CellIndex
    """Of the cells, (C,)."""
    z_m: NDArray[np.float32]
    """Mean height of the returns of each cell [m], (C,)."""
    above: NDArray[np.float32]
    """Part of them that was seen from above, (C,)."""
    of_cell: NDArray[np.int32]
    """Row of the cube of each cell, (C,)."""
    cubes: CellIndex
    """Of the cubes, (B,)."""
    of_cube: Array
    """Means x, y, z [m] of the returns of each cube, and the parts that were seen from above and
    of further echoes, (B, 5)."""


def find_structure(runs: CellRuns, walk_m: Array) -> Structure | None:
    """What stands in a map.

    Args:
        runs: Returns that were counted.
        walk_m: Positions of the body in the map, (W, 3).

    Returns:
        None where no ground is found below the walk.

    Raises:
        OSError: If a run cannot be written or read.
    """
    found = _cells(runs)
    if found is None:
        return None
    cells, cubes = found.cells, found.cubes
    planes = _planes(cubes, found.of_cube)
    steep = planes.normal.any(axis=1) & (np.abs(planes.normal[:, 2]) < STRUCTURE.steep)
    found.above[steep[found.of_cell]] = 0.0
    ground = _ground(found, walk_m=np.ascontiguousarray(walk_m, np.float64))
    if not ground.any():
        return None
    planes.flat[found.of_cell[ground]] = False
    seen_above, ground_m, cells = found.of_cube[:, 3], found.z_m[ground], indexed(cells.key[ground])
    del found, ground
    below, below_m = _below(cells.key, ground_m)
    near, growth = _things(cubes, planes, seen_above, ground=(below, below_m))
    return Structure(
        cells, ground_m, below, below_m, cubes, planes.normal, planes.offset, near, growth
    )


def _cells(runs: CellRuns) -> StructureCells | None:
    """What was counted; None = nothing."""
    parts = [_part(part) for part in runs.merged(least=STRUCTURE.least, most=STRUCTURE.most)]
    if not parts:
        return None
    key, z_m, above, cells_of, cube_key, of_cube = (
        np.concatenate(part) for part in zip(*parts, strict=True)
    )
    del parts
    of_cell = np.repeat(np.arange(len(cells_of), dtype=np.int32), cells_of)
    return StructureCells(indexed(key), z_m, above, of_cell, indexed(cube_key), of_cube)


def _part(cells: MergedCells) -> tuple[NDArray[np.generic], ...]:
    """Keys, mean heights, parts seen from above of cells; of their cubes how many cells they have,
    their keys, and the rest as in `StructureCells`.
    """
    numbers, count = cell_numbers(cells.key), cells.total[:, 0].astype(np.float64)
    sums = coordinate_sums(cells)
    z_m = (sums[:, 2] / count).astype(np.float32)
    above = (cells.total[:, 4] / count).astype(np.float32)
    numbers[:, 2] //= STRUCTURE.layers
    cube_key = cell_keys(numbers)
    starts = np.flatnonzero(np.diff(cube_key, prepend=-1))
    parts = np.concatenate([sums, cells.total[:, 4:]], axis=1)
    of_cube = np.add.reduceat(parts, starts) / np.add.reduceat(count, starts)[:, None]
    cells_of = np.diff(starts, append=len(cube_key))
    return cells.key, z_m, above, cells_of, cube_key[starts], of_cube


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


def _ground(found: StructureCells, *, walk_m: Array) -> NDArray[np.bool_]:
    """Which cells are ground: those that lead on from below the walk, (C,)."""
    cells, z_m = found.cells, found.z_m
    level, ground = np.empty((2, len(z_m)), np.bool_)
    ground[:] = False
    ground_cells.find_level(cells, found.above, GROUND, level)
    below = np.empty(len(walk_m), np.int64)
    ground_cells.find_below(cells, level, walk_m, GROUND, below)
    over_m = walk_m[below >= 0, 2] - z_m[below[below >= 0]]
    if not len(over_m):
        return ground
    carried = np.abs(over_m - np.median(over_m)) <= GROUND.same_m
    ground[below[below >= 0][carried]] = True
    queue = np.empty(len(z_m), np.int32)
    ground_cells.grow_ground(cells, z_m, level, GROUND, ground, queue)
    return ground


def _below(
    ground: NDArray[np.int64], ground_m: NDArray[np.float32]
) -> tuple[CellIndex, NDArray[np.float32]]:
    """Heights of the ground in cubes of one meter, spread to those around [m]."""
    numbers = cell_numbers(ground) // STRUCTURE.per_meter
    numbers[:, 2] = np.floor(ground_m)
    keys, heights = _mean_of(cell_keys(numbers), ground_m.astype(np.float64))
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
    under, count = np.unique(cell_keys(_flat(cells)), return_counts=True)
    under = under[count >= STRUCTURE.roofed * STRUCTURE.per_meter**2]
    covered = _wide(under)
    for _ in range(STRUCTURE.eaves):
        covered = np.unique(np.concatenate([covered, *_beside(covered)]))
    return np.isin(cell_keys(_flat(keys)), covered)


def _wide(keys: NDArray[np.int64]) -> NDArray[np.int64]:
    """Square meters with enough others around: no balconies."""
    reach, count = STRUCTURE.around, np.zeros(len(keys), np.int64)
    for i in range(-reach, reach + 1):
        for j in range(-reach, reach + 1):
            count += np.isin(keys + (i << 2 * KEY.each) + (j << KEY.each), keys)
    return keys[count >= STRUCTURE.wide]


def _flat(keys: NDArray[np.int64]) -> NDArray[np.int64]:
    """Numbers of the square meter of each cube, (C, 3)."""
    place = cell_numbers(keys) // STRUCTURE.per_meter
    place[:, 2] = 0
    return place
