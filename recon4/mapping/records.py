"""Records of 32 bytes per point while the map is built: sorted into tiles, thinned by voxel."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.sorting import radix_sort
from recon4.kernels.voxels import (
    BITS,
    HALO,
    PER_METER,
    choose,
    count_tiles,
    fill_tiles,
    nearest_in_voxels,
    voxel_keys,
)
from recon4.mapping.grid import Grid
from recon4.mapping.undistort import Placed
from recon4.model.classes import PointClass
from recon4.model.multiframe import Multiframe

RECORD = np.dtype(
    [
        ("xyz", "<f4", 3),  # from the tile's origin [m]
        ("frame", "<u4"),  # row of the multiframe
        ("dt_ns", "<i4"),
        ("to_sensor", "<i2", 3),  # in steps of 1 / PER_METER
        ("intensity", "<u2"),
        ("ring", "|u1"),
        ("sensor", "|u1"),
        ("echo", "|u1"),  # with the bits HALO and MARK
        ("returns", "|u1"),  # in the voxel, up to MAX_RETURNS
    ]
)
Records = NDArray[np.void]
_OPAQUE = f"V{RECORD.itemsize}"
"""Numpy copies records field by field, but opaque ones as a whole: six times as fast."""
MARKED = np.array(
    [PointClass.UNCLASSIFIED, PointClass.MOVING, PointClass.CARRIER, PointClass.REFLECTION],
    np.uint8,
)
"""Class of each mark of a record; all but the first are left out of the map."""
Tile = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class Views:
    """The same records as arrays of plain types, for the kernels."""

    f4: NDArray[np.float32]
    i4: NDArray[np.int32]
    i2: NDArray[np.int16]
    u1: NDArray[np.uint8]

    @staticmethod
    def of(records: Records) -> Views:
        """Views, (N, 8), (N, 8), (N, 16) and (N, 32)."""
        n = len(records)
        flat = np.ascontiguousarray(records).view(np.uint8).reshape(n, RECORD.itemsize)
        return Views(flat.view(np.float32), flat.view(np.int32), flat.view(np.int16), flat)


@dataclass(frozen=True, slots=True)
class ChosenPoints:
    """Which measured points are placed in the map."""

    enabled: NDArray[np.bool_]
    """Of each sensor, (S,)."""
    max_range_m: float
    """Farther ones are not [m]."""


def split_into_tiles(
    frame: Multiframe,
    placed: Placed,
    grid: Grid,
    *,
    chosen: ChosenPoints,
    classes: NDArray[np.uint8] | None = None,
) -> dict[Tile, Records]:
    """Records of a multiframe's points by tile, halos included; ``classes`` are (N,) if known."""
    enabled, max_range_m = chosen.enabled, chosen.max_range_m
    echo = frame.echo if classes is None else frame.echo | marks_of(classes)
    mine = np.empty(len(frame), np.bool_)
    least, most = np.empty(3), np.empty(3)
    xyz, origin = placed.xyz_m, placed.origin_m
    if not choose(xyz, origin, frame.sensor, enabled, max_range_m, mine, least, most):
        return {}
    low = np.floor(least / grid.tile_m).astype(np.int64) - 1
    high = np.floor(most / grid.tile_m).astype(np.int64) + 1
    counts = np.zeros(high - low + 1, np.int64)
    count_tiles(xyz, mine, grid.tile_m, grid.halo_m, low, counts)
    ends = np.cumsum(counts.ravel()).reshape(counts.shape)
    starts = ends - counts
    records = np.zeros(int(counts.sum()), RECORD)
    views = Views.of(records)
    fill_tiles(
        xyz,
        origin,
        mine,
        (frame.ring, frame.sensor, echo),
        frame.intensity,
        frame.dt_ns,
        frame.frame_id,
        grid.tile_m,
        grid.halo_m,
        low,
        starts.copy(),
        views.f4,
        views.i4,
        views.i2,
        views.u1,
    )
    found = np.argwhere(counts)
    return {
        (int(i + low[0]), int(j + low[1]), int(k + low[2])): records[
            starts[i, j, k] : ends[i, j, k]
        ]
        for i, j, k in found
    }


def in_voxel_order(records: Records, grid: Grid) -> Records:
    """Sort records by voxel and, when thinning, keep only the nearest of each voxel.

    Thinning a part first and the whole later gives the same result as thinning the whole.
    """
    n = len(records)
    if n == 0:
        return records
    views = Views.of(records)
    shift = n.bit_length()
    order, ranks = np.empty((2, n), np.int64)
    cells = grid.voxel_m, grid.cell_voxels, grid.side_cells, grid.halo_cells
    voxel_keys(views.f4, views.i2, views.u1, cells, shift, order, ranks)
    order = radix_sort(order, shift, shift + grid.key_bits, np.empty(n, np.int64))
    if not grid.thin:
        return np.take(records, order & ((1 << shift) - 1))
    returns = np.empty(n, np.uint8)
    count = nearest_in_voxels(order, shift, ranks, order, returns)
    kept = np.take(records, order[:count])
    kept["returns"] = returns[:count]
    return kept


def joined(parts: Sequence[Records]) -> Records:
    """All records of some parts in fresh memory."""
    return gathered(parts, np.empty(sum(map(len, parts)), RECORD))


def gathered(parts: Iterable[Records], out: Records) -> Records:
    """All records of some parts in ``out``; each is copied when it is made."""
    opaque, begin = out.view(_OPAQUE), 0
    for part in parts:
        opaque[begin : begin + len(part)] = part.view(_OPAQUE)
        begin += len(part)
    return out


def chosen_records(records: Records, which: NDArray[np.bool_]) -> Records:
    """Some of the records, (N,); all of them are not copied."""
    return records if which.all() else np.compress(which, records.view(_OPAQUE)).view(RECORD)


def marks_of(classes: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Marks of records beside their echoes, by the classes of the points, (N,)."""
    table = np.zeros(256, np.uint8)
    table[MARKED] = np.arange(len(MARKED)) << BITS.shift
    return np.asarray(table[classes])


def classes_of(records: Records) -> NDArray[np.uint8]:
    """Classes of records by their marks, (N,)."""
    return np.asarray(MARKED[(records["echo"] & BITS.mark) >> BITS.shift])


def is_own(records: Records) -> NDArray[np.bool_]:
    """Which records belong to the tile and not to its halo, (N,)."""
    return np.asarray(records["echo"] & HALO == 0)


def to_sensor_m(records: Records) -> NDArray[np.float32]:
    """Vectors from the points to the sensor [m], (N, 3), exact to 2 mm."""
    return records["to_sensor"].astype(np.float32) / np.float32(PER_METER)
