"""Convert the records of one tile to its columns in the map."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.halves import round_to_half
from recon4.kernels.intensity import apply_table
from recon4.kernels.structure_points import Structure
from recon4.kernels.surface_points import spread_surfaces
from recon4.kernels.surface_records import Moved
from recon4.kernels.voxels import face_sensor, seen_from_far, unpack
from recon4.mapping.deviation import PoseCovariances, point_deviations
from recon4.mapping.grid import Grid
from recon4.mapping.normals import Normals, local_normals
from recon4.mapping.records import (
    Records,
    Tile,
    Views,
    chosen_records,
    classes_of,
    is_own,
    to_sensor_m,
)
from recon4.mapping.sparse_surfaces import with_sparse_places
from recon4.mapping.structure import mark_structure
from recon4.mapping.surface_fit import FittedSurfaces
from recon4.mapping.surfaces import fit_surfaces
from recon4.mapping.tile_memory import TileMeans
from recon4.mapping.tile_order import stored_blocks
from recon4.mapping.tuning import TILES
from recon4.model.classes import PointClass, is_delivered
from recon4.model.intensity_table import IntensityTable
from recon4.model.trajectory import Times
from recon4.settings import MapSettings

if TYPE_CHECKING:  # it reads tiles, too
    from recon4.mapping.class_corrections import ClassVolumes

DEVIATION = "position_sd_m"
FIELDS: dict[str, tuple[str, int]] = {
    "xyz": ("<f4", 3),
    "intensity": ("<u2", 1),
    "intensity_normalized": ("<f4", 1),
    "ring": ("|u1", 1),
    "sensor": ("|u1", 1),
    "echo": ("|u1", 1),
    "classification": ("|u1", 1),
    "frame_id": ("<u4", 1),
    "t_ns": ("<i8", 1),
    "normal": ("<f2", 3),
    "range_m": ("<f4", 1),
    "incidence_rad": ("<f4", 1),
    "raw_offset_m": ("<f2", 3),
    "surface_returns": ("<u2", 1),
    "surface_sd_m": ("<f2", 1),
    "planarity": ("<f2", 1),
    DEVIATION: ("<f2", 1),
}
"""Name -> (dtype, width). ``intensity_normalized`` exists only with an intensity table,
``position_sd_m`` only where covariances of the poses are stated."""
DERIVED = ("range_m", "incidence_rad")
"""Follow from the other fields and the paths of the sensors; not stored."""
STORED = tuple(name for name in FIELDS if name not in DERIVED)
SURFACE_FIELDS = ("raw_offset_m", "surface_returns", "surface_sd_m", "planarity")
"""Exist only in maps of fitted surfaces."""
_MADE_ELSEWHERE = {
    *("normal", "intensity_normalized", "classification", DEVIATION),
    *SURFACE_FIELDS,
}


def mark_noise(classes: NDArray[np.uint8], surfaces: FittedSurfaces, min_neighborhood: int) -> None:
    """Mark stray returns: high noise if nothing else is around them, else low noise.

    Args:
        classes: Of all points; those of unclassified ones may change, (N,).
        surfaces: Of the points.
        min_neighborhood: Points with fewer in their neighborhood are noise.
    """
    open_ = classes == PointClass.UNCLASSIFIED
    stray = open_ & (surfaces.stray | (surfaces.support < min_neighborhood))
    rows = np.flatnonzero(stray)
    # Too few others around it for a normal: nothing else was measured there.
    alone = ~surfaces.surfaces[surfaces.surface_of[rows], :3].any(axis=1)
    classes[rows] = np.where(alone, PointClass.HIGH_NOISE, PointClass.LOW_NOISE)


def normalized_intensity(
    table: IntensityTable, columns: Mapping[str, NDArray[Any]]
) -> NDArray[np.float32]:
    """Normalized intensities, (N,).

    Args:
        table: Of the sensors of these points.
        columns: ``intensity`` (raw), ``sensor`` (row in the rig), ``ring``, ``incidence_rad``
            (between beam and normal, 0..pi/2, NaN = no normal) and ``range_m`` of the points, (N,).
    """
    out = np.empty(len(columns["intensity"]), np.float32)
    apply_table(
        columns["intensity"],
        columns["sensor"],
        columns["ring"],
        columns["incidence_rad"],
        columns["range_m"],
        table.incidence_bin_rad,
        table.range_bin_m,
        table.gain,
        table.offset,
        table.upper,
        out,
    )
    return out


Columns = dict[str, NDArray[Any]]


@dataclass(frozen=True, slots=True, eq=False)
class Recipe:
    """Parameters that are the same for all tiles."""

    grid: Grid
    settings: MapSettings
    intensity: IntensityTable | None
    t_ns: Times
    """Start of each multiframe [ns], (F,)."""
    noise_m: float
    """Standard deviation of a range [m]."""
    covariances: PoseCovariances | None = None
    """Of the multiframes; None = no deviations of the points."""
    corrections: ClassVolumes | None = None
    """Of classes by people; None = there are none."""
    structure: Structure | None = None
    """What stands in the map; None = it is not known."""


@dataclass(frozen=True, slots=True, eq=False)
class TilePlaces:
    """Where the points of a tile are, from its origin [m]."""

    measured: NDArray[np.float32]
    """Of all records, where they were measured, (N, 3)."""
    origin_m: Array
    """Of the tile in the map, (3,)."""
    in_map: Callable[[NDArray[np.intp]], NDArray[np.float32]]
    """Of some rows (M,), where the map has them, (M, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class MadeTile:
    """Columns of a tile, and counts of removed points by reason."""

    removed: Counter[str]
    blocks: Iterator[Callable[[], Columns]]
    """Makes the columns, block by block, each in spatial order."""
    points: int
    """Rows of the first blocks."""
    strays: int = 0
    """Rows of the other blocks, left out of the map: stray returns, the carrier, what moves."""
    corrected: Counter[int] = field(default_factory=Counter)
    """Number of a correction of classes -> how many points it changed."""
    classes: Counter[int] = field(default_factory=Counter)
    """Code of a class -> how many points of the tile have it."""


def make_tile(records: Records, tile: Tile, recipe: Recipe, *, means: TileMeans) -> MadeTile:
    """Remove noise from the records of a tile and compute the columns of the rest.

    Args:
        records: In the order of their voxels, thinned, with the halo.
        tile: Index of the tile.
        recipe: Parameters.
        means: Memory to work in, and threads.
    """
    settings = recipe.settings
    removed: Counter[str] = Counter()
    if settings.far_ratio > 0.0:
        records, removed["far"] = _without_far(records, settings.far_ratio)
    own, classes = is_own(records), classes_of(records)
    if settings.surface == "fitted":
        surfaces = _surfaces(records, classes, recipe, means=means)
        mark_noise(classes, surfaces, settings.min_neighborhood)
        normals = surfaces.surfaces, surfaces.surface_of
        columns = partial(_fitted_columns, records, surfaces, recipe=recipe)
    else:
        found = _normals(records, classes, recipe.grid.cell_m)
        stands = classes == PointClass.UNCLASSIFIED
        lonely = own & stands & (found.support < settings.min_neighborhood)
        removed["lonely"] = int(lonely.sum())
        own &= ~lonely
        columns = partial(_raw_columns, records, found, recipe=recipe)
        normals = _facing_sensor(found, records), np.arange(len(records), dtype=np.int32)
    origin_m = np.array(tile, dtype=np.float64) * recipe.grid.tile_m
    if recipe.structure is not None:
        made = recipe.structure
        mark_structure(classes, records["xyz"], origin_m, normals=normals, structure=made)
    corrected: Counter[int] = Counter()
    if recipe.corrections is not None:
        places = TilePlaces(records["xyz"], origin_m, lambda rows: columns(rows)["xyz"])
        corrected = recipe.corrections.apply_to_tile(classes, np.flatnonzero(own), places)
    delivered = is_delivered(classes)
    points, left_out = np.flatnonzero(own & delivered), np.flatnonzero(own & ~delivered)
    block = partial(_block, columns_of=columns, classes=classes, origin_m=origin_m, recipe=recipe)
    rows = chain(stored_blocks(points), stored_blocks(left_out))
    blocks = (partial(block, part) for part in rows)
    counts = np.bincount(classes[own], minlength=1)
    given = Counter({code: int(counts[code]) for code in np.flatnonzero(counts).tolist()})
    return MadeTile(removed, blocks, len(points), len(left_out), corrected, given)


def _block(
    rows: NDArray[np.intp],
    *,
    columns_of: Callable[[NDArray[np.intp]], Columns],
    classes: NDArray[np.uint8],
    origin_m: Array,
    recipe: Recipe,
) -> Columns:
    columns = columns_of(rows)
    columns["classification"] = classes[rows]
    if recipe.covariances:
        p_map = columns["xyz"] + origin_m
        columns[DEVIATION] = point_deviations(recipe.covariances, p_map, columns["frame_id"])
    return columns


def _surfaces(
    records: Records, classes: NDArray[np.uint8], recipe: Recipe, *, means: TileMeans
) -> FittedSurfaces:
    """The surfaces of what stands; nothing is fitted to what moves, or is no surface."""
    grid, noise_m = recipe.grid, recipe.noise_m
    stands = classes == PointClass.UNCLASSIFIED
    found = fit_surfaces(records, grid, noise_m=noise_m, stands=stands, means=means)
    return with_sparse_places(records, found, grid=grid, noise_m=noise_m, means=means)


def _normals(records: Records, classes: NDArray[np.uint8], cell_m: float) -> Normals:
    """Normals of what stands; zeros and no support elsewhere."""
    stands = classes == PointClass.UNCLASSIFIED
    made = local_normals(np.ascontiguousarray(records["xyz"][stands]), cell_m)
    normal, support = np.zeros((len(records), 3), np.float32), np.zeros(len(records), np.int32)
    normal[stands], support[stands] = made.normal, made.support
    return Normals(normal, support)


def _facing_sensor(normals: Normals, records: Records) -> NDArray[np.float32]:
    """Normals turned to the sensors, (N, 3)."""
    away = np.einsum("ni,ni->n", normals.normal, records["to_sensor"].astype(np.float32)) < 0.0
    return np.where(away[:, None], -normals.normal, normals.normal)


def _raw_columns(
    records: Records, normals: Normals, rows: NDArray[np.intp], *, recipe: Recipe
) -> Columns:
    return _columns(records, rows, np.take(normals.normal, rows, axis=0), recipe=recipe)


def _fitted_columns(
    records: Records, surfaces: FittedSurfaces, rows: NDArray[np.intp], *, recipe: Recipe
) -> Columns:
    """Columns with the points on their surfaces; ``raw_offset_m`` leads back."""
    n = len(rows)
    offset, normal = np.empty((2, n, 3), np.float32)
    facts, returns = np.empty((2, n), np.float32), np.empty(n, np.uint16)
    moved = Moved(surfaces.shift_m, surfaces.surface_of, surfaces.surfaces)
    spread_surfaces(rows, moved, offset, normal, facts, returns)
    columns = _columns(records, rows, normal, recipe=recipe)
    columns["xyz"] -= offset
    columns["raw_offset_m"] = as_half(offset)
    columns["surface_sd_m"] = as_half(facts[0])
    columns["planarity"] = as_half(facts[1])
    columns["surface_returns"] = returns
    return columns


def as_half(values: NDArray[np.float32]) -> NDArray[np.float16]:
    """The nearest float16 of values in any shape."""
    flat = np.ascontiguousarray(values).ravel()
    out = np.empty(len(flat), np.uint16)
    round_to_half(flat, flat.view(np.uint32), out)
    return out.view(np.float16).reshape(values.shape)


def _without_far(records: Records, ratio: float) -> tuple[Records, int]:
    own = is_own(records)
    keep = own.copy()
    range_m = np.linalg.norm(to_sensor_m(records), axis=1)
    seen_from_far(np.ascontiguousarray(records["xyz"]), range_m, TILES.far_cell_m, ratio, keep)
    return chosen_records(records, keep | ~own), int(own.sum() - keep.sum())


def _columns(
    records: Records, rows: NDArray[np.intp], normal: NDArray[np.float32], *, recipe: Recipe
) -> Columns:
    n = len(rows)
    columns: Columns = {
        name: np.empty((n, width) if width > 1 else n, dtype)
        for name, (dtype, width) in FIELDS.items()
        if name not in _MADE_ELSEWHERE
    }
    to_sensor = np.empty((n, 3), np.float32)
    views = Views.of(records)
    unpack(
        rows,
        views.f4,
        views.i4,
        views.i2,
        views.u1,
        recipe.t_ns,
        columns["xyz"],
        columns["intensity"],
        (columns["ring"], columns["sensor"], columns["echo"]),
        columns["frame_id"],
        columns["t_ns"],
        to_sensor,
    )
    face_sensor(normal, to_sensor, columns["range_m"], columns["incidence_rad"])
    columns["normal"] = as_half(normal)
    if recipe.intensity is not None:
        columns["intensity_normalized"] = normalized_intensity(recipe.intensity, columns)
    return columns
