"""The points of a map inside a slice, tile by tile, at full resolution."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.slices import project, select
from recon4.mapping.tile import Columns
from recon4.mapping.tiles import Tile, TileSet
from recon4.slices.slice_plane import SlicePlane
from recon4.slices.tuning_files import SLICE_POINTS


@dataclass(frozen=True, slots=True)
class SliceWindow:
    """Part of a slice, in its own coordinates u, v [m]."""

    left: float
    bottom: float
    right: float
    top: float


@dataclass(frozen=True, slots=True, eq=False)
class TilePart:
    """Points of one tile inside a slice."""

    tile: Tile
    rows: NDArray[np.int32]
    """Rows of the tile, (M,)."""
    uvd: Array
    """u, v and distance from the plane [m], float64 (M, 3)."""
    columns: Columns
    """The requested fields, (M,) each."""

    def __len__(self) -> int:
        return len(self.rows)


def points_in(
    tiles: TileSet,
    plane: SlicePlane,
    fields: Sequence[str] = (),
    *,
    window: SliceWindow | None = None,
) -> Iterator[TilePart]:
    """Points of the map in a slice. Tiles that it misses are not read.

    Args:
        tiles: The map.
        plane: The slab.
        fields: Names of fields besides the coordinates.
        window: Only what lies in this part of it.
    """
    low, high = box_of(plane, window)
    for tile in tiles:
        if not may_meet(tile, plane, low, high=high):
            continue
        columns = tile.read(["xyz", *fields])
        shift = plane.to_plane(np.array([tile.origin_m]))[0]
        for first in range(0, len(tile), SLICE_POINTS.block):
            xyz = columns["xyz"][first : first + SLICE_POINTS.block]
            rows = np.empty(len(xyz), np.int32)
            rows = rows[: select(xyz, plane.axes, shift, low, high, rows)].copy()
            if not len(rows):
                continue
            uvd = np.empty((len(rows), 3))
            project(xyz, rows, plane.axes, shift, uvd)
            rows += first
            taken = {name: np.take(columns[name], rows, axis=0) for name in fields}
            yield TilePart(tile, rows, uvd, taken)


def box_of(plane: SlicePlane, window: SliceWindow | None) -> tuple[Array, Array]:
    """Smallest and largest coordinates of a slice on its own axes [m], (3,) each."""
    half = plane.thickness_m / 2.0
    if window is None:
        return np.array([-np.inf, -np.inf, -half]), np.array([np.inf, np.inf, half])
    return (
        np.array([window.left, window.bottom, -half]),
        np.array([window.right, window.top, half]),
    )


def may_meet(tile: Tile, plane: SlicePlane, low: Array, *, high: Array) -> bool:
    """Whether a tile's bounding box can reach into the slice's box (a few more may seem to)."""
    center = (np.array(tile.low_m) + tile.high_m) / 2.0
    half = (np.array(tile.high_m) - tile.low_m) / 2.0 + 1e-5  # float32 rounding of the points
    middle = plane.to_plane(center[None])[0]
    reach = np.abs(plane.axes) @ half
    return bool(np.all(middle + reach >= low) and np.all(middle - reach <= high))


def extent(tiles: TileSet, plane: SlicePlane) -> SliceWindow:
    """Window that contains all of a slice: bounds of the tiles it meets [m]."""
    low, high = box_of(plane, None)
    met = [tile for tile in tiles if may_meet(tile, plane, low, high=high)]
    if not met:
        return SliceWindow(-1.0, -1.0, 1.0, 1.0)
    corners = np.array(
        [
            [[t.low_m, t.high_m][i][0], [t.low_m, t.high_m][j][1], [t.low_m, t.high_m][k][2]]
            for t in met
            for i in (0, 1)
            for j in (0, 1)
            for k in (0, 1)
        ]
    )
    uv = plane.to_plane(corners)[:, :2]
    (left, bottom), (right, top) = uv.min(axis=0).tolist(), uv.max(axis=0).tolist()
    return SliceWindow(left, bottom, right, top)
