"""Storeys of a building: found from its level surfaces and the heights at which it was walked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.products.tuning import STOREYS

Ints = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class BuildingStorey:
    """A floor that was walked on, and what is above it."""

    name: str
    """``0`` is where the walk begins, ``1`` the next one above, ``-1`` below."""
    floor_m: float
    """Height of the floor in the map [m]."""
    ceiling_m: float
    """Height of the ceiling of most of it in the map [m]."""
    area_m2: float
    """Area of the floor that was seen."""


@dataclass(frozen=True, slots=True, eq=False)
class Levels:
    """Level surfaces of a map, counted in columns of `STOREYS.column_m`."""

    column: Ints
    """Index of the column in x and y, (N, 2)."""
    level: Ints
    """Height in steps of `STOREYS.bin_m`, (N,)."""
    up: NDArray[np.bool_]
    """Whether it is seen from above: a floor, a table, (N,)."""
    area_m2: Array
    """Area in this column, (N,)."""

    @property
    def z_m(self) -> Array:
        """Middle of each level in the map [m], (N,)."""
        return np.asarray((self.level + 0.5) * STOREYS.bin_m, dtype=np.float64)

    def only(self, rows: NDArray[np.bool_]) -> Levels:
        """Some of them."""
        return Levels(self.column[rows], self.level[rows], self.up[rows], self.area_m2[rows])


def level_surfaces(tiles: TileSet) -> Levels:
    """Count the level surfaces of a map, tile by tile."""
    parts = [_of_tile(tile.read(["xyz", "normal"]), np.array(tile.origin_m)) for tile in tiles]
    if not parts:
        return Levels(
            np.empty((0, 2), np.int64), np.empty(0, np.int64), np.empty(0, bool), np.empty(0)
        )
    rows = np.concatenate([rows for rows, _ in parts])
    keys, inverse = _unique_rows(rows)
    areas = np.concatenate([area for _, area in parts])
    area: Array = np.bincount(inverse, areas, len(keys)).astype(np.float64)
    return Levels(keys[:, :2], keys[:, 2], keys[:, 3] > 0, area)


def _of_tile(columns: dict[str, NDArray[np.float32]], origin_m: Array) -> tuple[Ints, Array]:
    """Rows of column x, y, level, up, and their areas."""
    vertical = columns["normal"][:, 2].astype(np.float32)
    level = np.abs(vertical) > STOREYS.level
    p = columns["xyz"][level].astype(np.float64) + origin_m
    cell = np.floor(p[:, :2] / STOREYS.cell_m).astype(np.int64)
    z = np.floor(p[:, 2] / STOREYS.bin_m).astype(np.int64)
    cells, _ = _unique_rows(np.column_stack([cell, z, (vertical[level] > 0.0).astype(np.int64)]))
    cells[:, :2] //= round(STOREYS.column_m / STOREYS.cell_m)
    rows, inverse = _unique_rows(cells)
    count = np.bincount(inverse, minlength=len(rows)).astype(np.float64)
    return rows, count * STOREYS.cell_m**2


def _unique_rows(rows: Ints) -> tuple[Ints, NDArray[np.intp]]:
    """Different rows in their order, and which one each row is; as one number a row, if it fits."""
    if not len(rows):
        return rows, np.empty(0, np.intp)
    low = rows.min(axis=0)
    sizes = rows.max(axis=0) - low + 1
    if np.prod(sizes.astype(np.float64)) >= 2.0**62:
        found, inverse = np.unique(rows, axis=0, return_inverse=True)
        return found, inverse.reshape(-1)
    steps = np.append(np.cumprod(sizes[:0:-1])[::-1], 1)
    _, first, inverse = np.unique((rows - low) @ steps, return_index=True, return_inverse=True)
    return rows[first], inverse.reshape(-1)


def find_storeys(tiles: TileSet, levels: Levels | None = None) -> tuple[BuildingStorey, ...]:
    """Storeys of a map from the lowest up; none outdoors.

    A floor is a height at which much level surface is seen from above, above which the sensors
    were carried, and which is below a ceiling. Landings, steps and tables are nearer to a larger
    floor than `STOREYS.apart_m`; a ramp has no height.
    """
    floors: list[tuple[float, float]] = []
    if not tiles.columns.paths.known:
        return ()
    levels = level_surfaces(tiles) if levels is None else levels
    up = levels.only(levels.up)
    if not len(up.level):
        return ()
    first = int(up.level.min())
    area = np.bincount(up.level - first, up.area_m2).astype(np.float64)
    area = np.convolve(area, np.ones(3), "same")
    largest = 0.0
    for row in np.argsort(-area):
        z_m = (int(row) + first + 0.5) * STOREYS.bin_m
        if area[row] < max(STOREYS.least_area_m2, STOREYS.least_ratio * largest):
            break
        if any(abs(z_m - other) < STOREYS.apart_m for other, _ in floors):
            continue
        near = up.only(np.abs(up.z_m - z_m) < 1.5 * STOREYS.bin_m)
        if (
            _walked_s(tiles, near, z_m) < STOREYS.walked_s
            or _roofed(near, levels, z_m) < STOREYS.roofed
        ):
            continue
        largest = max(largest, float(area[row]))
        floors.append((float(np.average(near.z_m, weights=near.area_m2)), _area(near)))
    floors.sort()
    return _named(floors, tiles, levels)


def _named(
    floors: list[tuple[float, float]], tiles: TileSet, levels: Levels
) -> tuple[BuildingStorey, ...]:
    names = storey_names([z_m for z_m, _ in floors], float(tiles.columns.paths.p_map[0, 0, 2]))
    found = []
    for k, (z_m, area) in enumerate(floors):
        above = floors[k + 1][0] if k + 1 < len(floors) else np.inf
        ceiling = _ceiling(levels, z_m, above)
        found.append(BuildingStorey(names[k], z_m, ceiling, area))
    return tuple(found)


def storey_names(floors_m: Sequence[float], start_m: float) -> list[str]:
    """Names of storeys: ``0`` is where the walk begins, ``1`` the next one above, ``-1`` below.

    Args:
        floors_m: Heights of their floors, from the lowest up [m], (N,).
        start_m: Height of the sensors at the first pose [m].
    """
    below = [k for k, z_m in enumerate(floors_m) if z_m < start_m - STOREYS.body_m[0]]
    zero = below[-1] if below else 0
    return [str(k - zero) for k in range(len(floors_m))]


def _area(floor: Levels) -> float:
    """Area of a floor, whose points may lie in several steps of height [m²]."""
    _, column = np.unique(floor.column, axis=0, return_inverse=True)
    return float(
        np.minimum(np.bincount(column.reshape(-1), floor.area_m2), STOREYS.column_m**2).sum()
    )


def _walked_s(tiles: TileSet, floor: Levels, z_m: float) -> float:
    """How long the sensors were carried above a floor [s]."""
    paths = tiles.columns.paths
    p, step_s = paths.p_map[0], 1e-9 * np.diff(paths.t_ns, append=paths.t_ns[-1])
    low, high = STOREYS.body_m
    above = (p[:, 2] - z_m > low) & (p[:, 2] - z_m < high)
    return float(step_s[above][_in_columns(p[above, :2], floor.column)].sum())


def _in_columns(xy_m: Array, columns: Ints) -> NDArray[np.bool_]:
    """Which places are in some columns or beside them, (N,)."""
    own = np.floor(xy_m / STOREYS.column_m).astype(np.int64)
    known = set(map(tuple, columns.tolist()))
    steps = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    return np.array(
        [any((x + i, y + j) in known for i, j in steps) for x, y in own.tolist()], dtype=bool
    )


def _roofed(floor: Levels, levels: Levels, z_m: float) -> float:
    """Part of a floor's columns that are below a ceiling."""
    low, high = STOREYS.ceiling_m
    over = levels.z_m - z_m
    above = set(map(tuple, levels.column[~levels.up & (over > low) & (over < high)].tolist()))
    own = set(map(tuple, floor.column.tolist()))
    return len(own & above) / max(1, len(own))


def _ceiling(levels: Levels, floor_m: float, next_m: float) -> float:
    """Height of the ceiling of most of a storey; the usual one if none was seen [m]."""
    low, high = STOREYS.ceiling_m
    over = levels.z_m - floor_m
    rows = ~levels.up & (over > low) & (over < high) & (levels.z_m < next_m)
    if not rows.any():
        return min(floor_m + STOREYS.usual_m, next_m)
    first = int(levels.level[rows].min())
    area = np.bincount(levels.level[rows] - first, levels.area_m2[rows])
    return float((first + int(np.argmax(area)) + 0.5) * STOREYS.bin_m)


def storey_named(storeys: tuple[BuildingStorey, ...], name: str) -> BuildingStorey:
    """One storey by its name.

    Raises:
        ConfigError: If there is none of this name.
    """
    for storey in storeys:
        if storey.name == name:
            return storey
    if not storeys:
        raise ConfigError(CodedText("storeys-none"))
    names = ", ".join(f"{one.name} (floor at {one.floor_m:.2f} m)" for one in storeys)
    raise ConfigError(CodedText("storey-unknown", name=name, names=names))


def storey_heights(storeys: tuple[BuildingStorey, ...], name: str) -> tuple[float, float]:
    """From below the floor of a storey to below that of the next one, in the map [m].

    Raises:
        ConfigError: If there is none of this name.
    """
    one = storey_named(storeys, name)
    above = [other.floor_m for other in storeys if other.floor_m > one.floor_m]
    high = min(above) - STOREYS.slab_m if above else np.inf
    return one.floor_m - STOREYS.slab_m, float(high)
