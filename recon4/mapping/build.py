"""The stage ``map``: place all points, thin them, compute their fields, store them in tiles."""

from __future__ import annotations

from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from recon4.mapping.buckets import TileBuckets
from recon4.mapping.cell_runs import CellRuns
from recon4.mapping.class_corrections import ClassVolumes
from recon4.mapping.deviation import PoseCovariances
from recon4.mapping.finish import finished_tiles
from recon4.mapping.grid import Grid
from recon4.mapping.made_tiles import (
    MadeTiles,
    TileCounts,
    keep_placed,
    placing_folder,
    take_placed,
)
from recon4.mapping.map_notes import MapCrs, MapNotes
from recon4.mapping.ordered_tiles import OrderedTiles
from recon4.mapping.records import ChosenPoints, Records, Tile, split_into_tiles
from recon4.mapping.sensor_paths import SensorPaths
from recon4.mapping.structure import find_structure
from recon4.mapping.structure_tuning import STRUCTURE
from recon4.mapping.threads import InThreads, in_order
from recon4.mapping.tile import DERIVED, DEVIATION, FIELDS, SURFACE_FIELDS, Recipe
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tiles import TileSet
from recon4.mapping.tuning import BUCKETS, MAP_BUILD, TILE_SURFACES
from recon4.mapping.undistort import Placed, place_with_origins
from recon4.model.classes import PointClass
from recon4.model.events import MapBuilt
from recon4.model.frames import Frames
from recon4.model.intensity_table import IntensityTable
from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig
from recon4.model.trajectory import Times, Trajectory
from recon4.orders.order import Workers
from recon4.progress import Progress, Silent, track
from recon4.sandbox.freed_memory import return_freed_memory
from recon4.settings import MapSettings


class PointClasses(Protocol):
    """Classes of measured points; `recon4.store.classes` reads them."""

    def of(self, row: int, count: int) -> NDArray[np.uint8]:
        """Those of a multiframe by its number and how many points it has, (N,)."""


@dataclass(frozen=True, slots=True, eq=False)
class MapInputs:
    """What a map is made of."""

    frames: Frames
    """The points in the frames of their sensors."""
    trajectory: Trajectory
    """``T_map_body``, dense."""
    intensity: IntensityTable | None = None
    """Normalizes intensities; None = the map has no normalized ones."""
    crs: MapCrs | None = None
    """CRS of the map, if it is georeferenced."""
    covariances: PoseCovariances | None = None
    """Of the multiframes; None = the map has no deviations of its points."""
    classes: PointClasses | None = None
    """Of the measured points; None = nothing is known to move, to be the carrier or reflected, and
    ground, buildings and vegetation are not looked for."""
    corrections: ClassVolumes | None = None
    """Of classes by people; None = there are none."""


@dataclass(frozen=True, slots=True)
class MapMeans:
    """What a map is made with; its bytes do not depend on it."""

    workers: Workers | None = None
    """Who makes the tiles; None = threads of this process."""
    burst: int = BUCKETS.burst
    """Points collected before a write."""


def build_map(
    inputs: MapInputs,
    out: Path,
    *,
    settings: MapSettings,
    progress: Progress | None = None,
    means: MapMeans = MapMeans(),
) -> TileSet:
    """Write ``tiles/`` and ``tiles.json`` into a folder.

    First every multiframe is placed and its points are distributed to the tiles, on disk. Then
    each tile is thinned and cleaned, and its fields are computed. Memory depends on the largest
    tile, not on the walk.

    Args:
        inputs: The multiframes and what belongs to them.
        out: The stage's folder; needs 32 bytes of disk space per point.
        settings: Settings of the map.
        progress: Receives the progress.
        means: Who makes the tiles.

    Raises:
        OutOfRange: If the trajectory does not cover the frames.
        StoreError: If the folder cannot be written (`NoSpace` when the disk is full).
    """
    progress = progress or Silent()
    grid = Grid.of(settings)
    with placing_folder(out) as folder:
        buckets = TileBuckets(folder, grid, burst=means.burst)
        recipe = _placed(inputs, folder, buckets, settings=settings, progress=progress)
        paths = SensorPaths.of(recipe.t_ns, inputs.trajectory, inputs.frames.rig)
        with TileWriter(out, _fields(recipe), tile_m=grid.tile_m, paths=paths) as writer:
            done = _finish_tiles(buckets, recipe, writer, means=means, progress=progress)
            writer.notes = _notes(inputs, settings, done)
    made = TileSet.open(out)
    progress.event(MapBuilt(points=len(made), removed=dict(done.removed)))
    return made


def surface_noise_m(rig: Rig) -> float:
    """How far returns lie from their surface: by the ranges of the least exact LiDAR in use [m]."""
    used = [lidar_model(sensor.model) for sensor in rig.sensors if sensor.enabled]
    return max([TILE_SURFACES.least_noise_m, *(model.range_sd_m for model in used)])


def _fields(recipe: Recipe) -> list[str]:
    """Fields of the map, in their order: some need an intensity table or fitted surfaces."""
    left_out = set(DERIVED)
    left_out |= set() if recipe.intensity else {"intensity_normalized"}
    left_out |= set() if recipe.covariances else {DEVIATION}
    left_out |= set(SURFACE_FIELDS) if recipe.settings.surface == "raw" else set()
    return [name for name in FIELDS if name not in left_out]


def _placed(
    inputs: MapInputs,
    folder: Path,
    buckets: TileBuckets,
    *,
    settings: MapSettings,
    progress: Progress,
) -> Recipe:
    """Put all points into their buckets, unless a run that was stopped did.

    Returns:
        How their tiles are made.
    """
    cells = CellRuns(folder)
    starts = take_placed(folder, buckets, cells)
    if starts is None:
        starts = _distribute(inputs, buckets, cells, settings=settings, progress=progress)
        keep_placed(folder, buckets, cells, starts=starts)
    return Recipe(
        Grid.of(settings),
        settings,
        inputs.intensity,
        starts,
        settings.range_noise_m or surface_noise_m(inputs.frames.rig),
        inputs.covariances,
        inputs.corrections,
        find_structure(cells, inputs.trajectory.T_a_b.t),
    )


def _distribute(
    inputs: MapInputs,
    buckets: TileBuckets,
    cells: CellRuns,
    *,
    settings: MapSettings,
    progress: Progress,
) -> Times:
    """Put every point into the buckets of its tiles, and count it in the cells of what stands.

    Returns:
        The start of each multiframe [ns].
    """
    frames = inputs.frames
    grid, rig = Grid.of(settings), frames.rig
    enabled = np.array([sensor.enabled for sensor in rig.sensors])
    chosen = ChosenPoints(enabled, settings.max_range_m)
    starts = np.zeros(len(frames), np.int64)

    def split(k: int) -> tuple[dict[Tile, Records], _Counted | None]:
        frame = frames[k]
        starts[k] = frame.t_ns
        placed = place_with_origins(frame, inputs.trajectory, rig)
        classes = inputs.classes.of(k, len(frame)) if inputs.classes else None
        parts = split_into_tiles(frame, placed, grid, chosen=chosen, classes=classes)
        if classes is None:
            return parts, None
        stands = enabled[frame.sensor] & (classes == PointClass.UNCLASSIFIED)
        return parts, (placed, stands, frame.echo)

    with ThreadPoolExecutor(MAP_BUILD.workers) as pool:
        parts = in_order(pool, split, range(len(frames)))
        counted = track(parts, progress, what="place points", unit="frames", total=len(frames))
        last_ns: int | None = None
        for k, (part, returns) in enumerate(counted):
            buckets.add(part, pool)
            t_ns = int(starts[k])
            if returns and (last_ns is None or t_ns - last_ns >= STRUCTURE.every_ns):
                cells.add(*returns)
                last_ns = t_ns
        buckets.flush(pool)
    return_freed_memory()
    return starts


_Counted = tuple[Placed, NDArray[np.bool_], NDArray[np.uint8]]
"""Arguments of `CellRuns.add`."""


def _finish_tiles(
    buckets: TileBuckets,
    recipe: Recipe,
    writer: TileWriter,
    *,
    means: MapMeans,
    progress: Progress,
) -> TileCounts:
    """Write all tiles; what became of their points."""
    counts = TileCounts(Counter(), Counter(), Counter())
    tiles, log = buckets.tiles(), MadeTiles()
    rest = tiles[len(log) :]
    with ThreadPoolExecutor(MAP_BUILD.workers) as pool:
        if means.workers is None:
            finished = finished_tiles(buckets, rest, pool, recipe=recipe, writer=writer)
        else:
            each = InThreads(pool)
            ordered = OrderedTiles(buckets, rest, means.workers, each, progress)
            finished = ordered.finished(recipe, writer)
        made = chain(log.earlier(), map(log.kept, finished))
        for tile, (packed, part) in zip(
            tiles, track(made, progress, what="map", unit="tiles", total=len(tiles)), strict=True
        ):
            writer.write(packed)
            buckets.drop(tile)
            counts.removed.update(part.removed)
            counts.corrected.update(part.corrected)
            counts.classes.update(part.classes)
    return counts


def _notes(inputs: MapInputs, settings: MapSettings, done: TileCounts) -> MapNotes:
    """What the map says of itself."""
    return MapNotes(
        voxel_m=settings.voxel_m,
        crs=inputs.crs,
        sensors=tuple(sensor.name for sensor in inputs.frames.rig.sensors),
        removed=dict(done.removed),
        classes=dict(done.classes),
        corrected=_counts(inputs.corrections, done.corrected),
    )


def _counts(corrections: ClassVolumes | None, changed: Counter[int]) -> tuple[int, ...]:
    return tuple(changed[k] for k in range(len(corrections.steps))) if corrections else ()
