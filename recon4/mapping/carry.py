"""Decisions that hardly bend the map carry its points along, in place of a new map.

Each point moves with its multiframe. What its surroundings do otherwise is looked at first: a
surface was fitted to returns of several visits, and stays one only where these move alike. What is
carried is always the map without decisions, so that small moves do not add up, and the result
follows from the inputs alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.deskew import move_with_frames
from recon4.kernels.normals import bounds
from recon4.mapping.columns import PackedColumns
from recon4.mapping.deviation import PoseCovariances, point_deviations
from recon4.mapping.map_notes import read_map_list
from recon4.mapping.sensor_paths import SensorPaths
from recon4.mapping.threads import in_order
from recon4.mapping.tile import DEVIATION, Columns
from recon4.mapping.tile_packing import PackedField, as_stored, pack
from recon4.mapping.tile_writer import PackedTile, TileBlock, TileRow, TileWriter
from recon4.mapping.tiles import Tile, TileSet
from recon4.mapping.tuning import CARRY, MAP_BUILD, TILES
from recon4.model.events import MapBuilt
from recon4.model.rig import Rig
from recon4.model.trajectory import Times, Trajectory
from recon4.progress import Progress, track


@dataclass(frozen=True, slots=True, eq=False)
class CarriedTo:
    """Where a map is carried."""

    rig: Rig
    trajectory: Trajectory
    """``T_map_body`` with the decisions, dense."""
    t_mid_ns: Times
    """Middle of each multiframe [ns], (F,)."""
    covariances: PoseCovariances | None
    """Of the multiframes with the decisions; None = the map has no deviations of its points."""

    def moves_from(self, before: Trajectory) -> SE3:
        """What the decisions move each multiframe by, in the map, a batch of F."""
        inside = np.clip(self.t_mid_ns, before.t_ns[0], before.t_ns[-1])
        return self.trajectory.at(inside) @ before.at(inside).inverse()


def carry_map(
    made: Path, before: Trajectory, to: CarriedTo, *, out: Path, progress: Progress
) -> float | None:
    """Write ``tiles/`` and ``tiles.json`` of a map whose points move with their multiframes.

    Args:
        made: Artifact of the stage ``map`` without decisions.
        before: ``T_map_body`` without them.
        to: Where it is carried.
        out: Folder of the stage.
        progress: Receives the progress.

    Returns:
        Its `bent_ratio`; None if that is too large: nothing was written.

    Raises:
        StoreError: If the map is damaged, or the folder cannot be written (`NoSpace`).
    """
    tiles, moves = TileSet.open(made), to.moves_from(before)
    bent = bent_ratio(tiles, moves)
    if bent > CARRY.bent_ratio or (DEVIATION in tiles.fields) != (to.covariances is not None):
        return None
    assert isinstance(tiles.columns, PackedColumns)
    carrier = _Carrier(tiles.columns, moves, to.covariances)
    paths = SensorPaths.of(tiles.columns.paths.frame_ns, to.trajectory, to.rig)
    rows = read_map_list(made / "tiles.json")["tiles"]
    with (
        TileWriter(out, tiles.columns.fields, tile_m=tiles.tile_m, paths=paths) as writer,
        ThreadPoolExecutor(MAP_BUILD.workers) as pool,
    ):
        moved = in_order(pool, carrier.moved, list(zip(tiles, rows, strict=True)))
        for tile in track(moved, progress, what="map", unit="tiles", total=len(rows)):
            writer.write(tile)
        writer.notes = tiles.notes
    progress.event(MapBuilt(points=len(tiles), removed=dict(tiles.notes.removed)))
    return bent


def bent_ratio(tiles: TileSet, moves: SE3) -> float:
    """Ratio of points that leave the surface which their surroundings make.

    A point moves with its multiframe, a surface by the mean of the returns around: across it, the
    two may differ by `CARRY.bent_m`.

    Args:
        tiles: The map, of which a sample is read.
        moves: What each multiframe moves by, in the map, a batch of F.
    """
    bent, count = 0, 0
    for tile in tiles:
        found = tile.read(["xyz", "normal", "frame_id"], limit=-(-len(tile) // TILES.sample))
        off_m = _off_m(found, moves, np.array(tile.origin_m))
        bent += int(np.count_nonzero(off_m > CARRY.bent_m))
        count += len(off_m)
    return bent / max(count, 1)


def _off_m(points: Columns, moves: SE3, origin_m: Array) -> Array:
    """By how much points move otherwise than those around, across their surface [m], (N,)."""
    xyz, normal = points["xyz"], points["normal"].astype(np.float64)
    motion = (
        moved_points(xyz, points["frame_id"], moves, origin_m=origin_m).astype(np.float64) - xyz
    )
    cube = np.floor(xyz / CARRY.around_m).astype(np.int64)
    _, around = np.unique(cube, axis=0, return_inverse=True)
    around = around.ravel()
    mean = np.stack([np.bincount(around, one) for one in motion.T], axis=1)
    off = motion - (mean / np.bincount(around)[:, None])[around]
    across = np.abs(np.einsum("ni,ni->n", off, normal))
    return np.where(normal.any(axis=1), across, np.linalg.norm(off, axis=1))


def moved_points(
    xyz: NDArray[np.float32], frame_id: NDArray[np.uint32], moves: SE3, *, origin_m: Array
) -> NDArray[np.float32]:
    """Points that move with their multiframes, from the same origin [m], (N, 3).

    Args:
        xyz: From the origin [m], (N, 3).
        frame_id: Multiframe of each, (N,).
        moves: Of the multiframes in the map, a batch of F.
        origin_m: In the map [m], (3,).
    """
    out = np.empty_like(xyz)
    move_with_frames(xyz, frame_id, moves.R, moves.t, origin_m, out)
    return out


@dataclass(frozen=True, slots=True, eq=False)
class _Carrier:
    """Moves the tiles of a map; only fields that change are unpacked."""

    columns: PackedColumns
    moves: SE3
    """Of the multiframes."""
    covariances: PoseCovariances | None

    def moved(self, listed: tuple[Tile, Mapping[str, Any]]) -> PackedTile:
        """A tile and its entry in ``tiles.json`` -> the tile as it will be stored."""
        tile, entry = listed
        row = TileRow(ijk=list(tile.ijk), origin_m=list(tile.origin_m), strays=tile.strays)
        row.time_ns = [int(t_ns) for t_ns in entry["time_ns"]]
        stop, packed = tile.stop + tile.strays, list[TileBlock]()
        for number, first in self.columns.blocks(tile.start, stop):
            block = self._block(number, np.array(tile.origin_m), (row.time_ns[0], row.time_ns[1]))
            # A tile of strays only has their bounds, as in `TileWriter.pack`.
            if first < tile.stop or not len(tile):
                row.extend(block)
            packed.append(block)
        return PackedTile(row, stop - tile.start, packed)

    def _block(self, number: int, origin_m: Array, time_ns: tuple[int, int]) -> TileBlock:
        columns = self.columns
        found = columns.unpacked(number, ["xyz", "frame_id"])
        frame_id = found["frame_id"]
        changed: Columns = {
            "xyz": moved_points(found["xyz"], frame_id, self.moves, origin_m=origin_m)
        }
        if self.covariances is not None:
            p_map = changed["xyz"] + origin_m
            changed[DEVIATION] = point_deviations(self.covariances, p_map, frame_id)
        made: list[PackedField] = [
            pack(name, changed[name]) if name in changed else columns.packed(name, number)
            for name in columns.fields
        ]
        corners = np.empty((2, 3))
        bounds(changed["xyz"], *corners)
        low_m, high_m = as_stored("xyz", corners) + origin_m
        return TileBlock(
            len(frame_id),
            [one.data for one in made],
            [one.width for one in made],
            low_m.tolist(),
            high_m.tolist(),
            time_ns,
        )
