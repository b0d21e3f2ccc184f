"""The index of a map for its page: tiles, columns, robust extent and storeys."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from recon4.first_view.cubes import coarse_sizes, cubes_of
from recon4.first_view.points import FIELD_OF, read_shown, sample_sizes, steps_of, values_of
from recon4.first_view.records import ColumnName, MapColumn, MapIndex, MapTile, Storey
from recon4.first_view.surfaces import cells_m2, sides_m2, surfaces_m2
from recon4.first_view.tuning import FIRST_VIEW, MAP_CHUNKS
from recon4.geometry.se3 import Array
from recon4.mapping.tiles import TileSet
from recon4.model.classes import CLASSES, PointClass, is_delivered
from recon4.products.storeys import storey_names

Columns = dict[str, NDArray[Any]]


def index_of(tiles: TileSet, *, crs: str, frame: str, walk_m: Array) -> MapIndex:
    """Make the index; it has no key yet, as it is a part of the artifact that has it.

    Args:
        tiles: The map.
        crs: As `MapIndex` has it.
        frame: As `MapIndex` has it.
        walk_m: Positions of the sensors [m], (W, 3).
    """
    names = [name for name in get_args(ColumnName) if FIELD_OF[name] in tiles.fields]
    sizes = sample_sizes(tiles)
    sample = _sample(tiles, sizes, ["xyz"])["xyz"]
    low, high = _extent(sample)
    found = _values(tiles, names)
    sampled = np.unique(found["classification"]).tolist() if "classification" in found else []
    percent = _class_percent(tiles)
    columns = [_column(name, found[FIELD_OF[name]], tiles) for name in names]
    return MapIndex(
        key="",
        version=MAP_CHUNKS.version,
        points=len(tiles),
        low_m=_xyz(low),
        high_m=_xyz(high),
        tiles=_tiles(tiles, sizes, sample),
        columns=columns,
        color=usual_color(columns),
        classes={int(code): class_name(int(code)) for code in percent or sampled},
        class_percent=percent,
        storeys=storeys(found["xyz"], found.get("normal"), walk_m),
        crs=crs,
        frame=frame,
        surface=tiles.surface,
        seconds=(tiles.last_ns - tiles.first_ns) / 1e9,
    )


def usual_color(columns: Sequence[MapColumn]) -> Literal["normalized", "intensity", "height"]:
    """By what points are colored at first, as recordings may have no or empty intensities."""
    varied = {one.name for one in columns if one.high - one.low > FIRST_VIEW.varied * one.scale}
    if "normalized" in varied:
        return "normalized"
    return "intensity" if "intensity" in varied else "height"


def _class_percent(tiles: TileSet) -> dict[int, float]:
    """Part of the points of a map that have each class [%]; empty if they were not counted."""
    codes = np.array(sorted(tiles.notes.classes), np.uint8)
    counts = {code: tiles.notes.classes[code] for code in codes[is_delivered(codes)].tolist()}
    total = max(sum(counts.values()), 1)
    return {code: round(100.0 * n / total, 2) for code, n in counts.items()}


def class_name(code: int) -> str:
    """The name of a class, by its code."""
    known = code in set(PointClass)
    return CLASSES[PointClass(code)].title if known else f"class {code}"


def storeys(p_map: Array, normal: NDArray[Any] | None, walk_m: Array) -> list[Storey]:
    """The storeys of a walk, from below: where it stayed at one height, with its floor.

    They are named as those of plans and exports.

    Args:
        p_map: A sample of the map [m], (N, 3).
        normal: Its normals, towards the sensors, (N, 3); None = the map has none.
        walk_m: Positions of the sensors in the order of the walk [m], (W, 3).
    """
    if not len(walk_m):
        return []
    heights = np.sort(walk_m[:, 2])
    top_m = float(heights[-1])
    found = [_storey(p_map[:, 2], normal, one, top_m=top_m) for one in _levels(heights)]
    known = sorted((one for one in found if one is not None), key=lambda one: one.floor_m)
    names = storey_names([one.floor_m for one in known], float(walk_m[0, 2]))
    return [replace(one, name=name) for one, name in zip(known, names, strict=True)]


def _levels(heights: Array) -> list[Array]:
    """The parts of a walk that stay at one height, from below; stairs and slopes are none.

    Args:
        heights: Of the walk, in order [m], (W,).
    """
    least = FIRST_VIEW.storey_percent / 100.0 * len(heights)
    found: list[tuple[float, Array]] = []
    centers = np.unique(np.round(heights / FIRST_VIEW.bin_m)) * FIRST_VIEW.bin_m
    on, near = (
        _count_within(heights, centers, away)
        for away in (FIRST_VIEW.level_m, FIRST_VIEW.storey_gap_m / 2.0)
    )
    for k in np.argsort(-on, kind="stable"):
        if on[k] < least or on[k] < FIRST_VIEW.level_ratio * near[k]:
            continue
        if all(abs(centers[k] - other) > FIRST_VIEW.storey_gap_m for other, _ in found):
            rows = np.abs(heights - centers[k]) <= FIRST_VIEW.level_m
            found.append((float(centers[k]), heights[rows]))
    return [part for _, part in sorted(found, key=lambda one: one[0])]


def _count_within(heights: Array, centers: Array, away_m: float) -> NDArray[np.int64]:
    last = np.searchsorted(heights, centers + away_m, side="right")
    return np.asarray(last - np.searchsorted(heights, centers - away_m), dtype=np.int64)


def _storey(
    z_m: Array, normal: NDArray[Any] | None, walk_z: Array, *, top_m: float
) -> Storey | None:
    walk = float(np.median(walk_z))
    near, far = FIRST_VIEW.carried_m
    up = np.ones(len(z_m)) if normal is None else normal[:, 2].astype(np.float64)
    floor = z_m[(up > FIRST_VIEW.upright) & (z_m > walk - far) & (z_m < walk - near)]
    if not len(floor):
        return None
    bins = np.floor(floor / FIRST_VIEW.bin_m).astype(np.int64)
    counts = np.bincount(bins - bins.min())
    level = FIRST_VIEW.bin_m * (int(bins.min()) + int(np.argmax(counts)) + 0.5)
    above = (z_m > walk) & (z_m < level + 2.0 * far)
    down = np.count_nonzero(above & (np.abs(up) > FIRST_VIEW.upright))
    hidden = normal is not None and top_m < level + far
    has = hidden and down > FIRST_VIEW.ceiling_ratio * len(floor)
    return Storey(name="", floor_m=round(level, 3), walk_m=round(walk, 3), ceiling=bool(has))


def _values(tiles: TileSet, names: list[ColumnName]) -> Columns:
    """Positions, values, normals and classes of a sample of some tiles.

    Each tile costs as much as its first points do however few are taken, so a large map is known
    by some of its tiles.
    """
    chosen = tiles.tiles
    if len(chosen) > FIRST_VIEW.most_tiles:
        rows = np.random.default_rng(1).choice(len(chosen), FIRST_VIEW.most_tiles, replace=False)
        chosen = tuple(chosen[row] for row in np.sort(rows).tolist())
    some = replace(tiles, tiles=chosen, points=sum(map(len, chosen)))
    fields = ["xyz", *(FIELD_OF[name] for name in names)]
    fields += [name for name in ("normal", "classification") if name in tiles.fields]
    return _sample(some, sample_sizes(some), fields)


def _sample(tiles: TileSet, sizes: NDArray[np.int64], fields: list[str]) -> Columns:
    parts = []
    for tile, size in zip(tiles, sizes.tolist(), strict=True):
        part = dict(read_shown(tile, fields, slice(0, size)))
        part["xyz"] = part["xyz"].astype(np.float64) + tile.origin_m
        parts.append(part)
    if not parts:
        return {name: np.empty((0, 3) if name in ("xyz", "normal") else 0) for name in fields}
    return {name: np.concatenate([part[name] for part in parts]) for name in fields}


def _extent(p_map: Array) -> tuple[Array, Array]:
    if not len(p_map):
        return np.zeros(3), np.zeros(3)
    low, high = np.percentile(p_map, FIRST_VIEW.extent_percent, axis=0)
    margin = FIRST_VIEW.margin * (high - low)
    return low - margin, high + margin


def _tiles(tiles: TileSet, sizes: NDArray[np.int64], sample: Array) -> list[MapTile]:
    least_m2 = cells_m2(tiles)
    most_m2 = np.maximum(sides_m2(tiles), least_m2)
    area_m2 = np.minimum(surfaces_m2(sample, sizes, least_m2), most_m2)
    cube = np.zeros(len(tiles.tiles), np.int64)
    for row, own in enumerate(cubes_of(tiles)):
        cube[own] = row
    return [
        MapTile(
            low_m=tile.low_m,
            high_m=tile.high_m,
            points=len(tile),
            sample=int(size),
            coarse=int(coarse),
            cube=int(row),
            spacing_m=float(np.sqrt(area / max(len(tile), 1))),
        )
        for tile, size, coarse, row, area in zip(
            tiles, sizes, coarse_sizes(tiles), cube, area_m2, strict=True
        )
    ]


def _column(name: ColumnName, stored: NDArray[Any], tiles: TileSet) -> MapColumn:
    values = values_of(name, stored, tiles)
    values = values[np.isfinite(values)]
    low, high = np.percentile(values, FIRST_VIEW.usual_percent) if len(values) else (0.0, 1.0)
    offset, scale = steps_of(name, tiles)
    unit = {"time": "s", "uncertainty": "m", "thickness": "m"}.get(name, "")
    high = max(float(high), float(low) + scale)
    return MapColumn(name=name, unit=unit, offset=offset, scale=scale, low=float(low), high=high)


def _xyz(values: Array) -> tuple[float, float, float]:
    x, y, z = values.tolist()
    return x, y, z
