"""What the packets of LiDARs that spin have in common: tables of their beams, and points from them.

A family makes `SpinningTables` of a sensor once; `spinning_points` does the rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from recon4.kernels.returns import AT, Decoded
from recon4.kernels.spinning import (
    BEAM,
    CIRCLE,
    BlockRoles,
    Channels,
    Distances,
    Layout,
    decode,
)
from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings

Columns = tuple[
    Times, NDArray[np.float32], NDArray[np.uint16], NDArray[np.uint8], NDArray[np.uint8]
]
"""Those of `Shots` after the sensor."""

_COUNTS = ("points_no_return", "points_near", "points_far", "azimuth_jumps")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SpinningTables:
    """All that turns the packets of one sensor into points."""

    layout: Layout
    roles: BlockRoles
    channels: Channels
    distances: Distances

    def __post_init__(self) -> None:
        """Check that the kernel, which checks nothing, stays within its arrays."""
        layout, roles, channels = self.layout, self.roles, self.channels
        variants, read, width = roles.time_ns.shape
        assert roles.group.shape == (variants,)
        for array in (roles.block, roles.twin, roles.table):
            assert array.shape == (variants, read)
        assert width == layout.channels
        assert layout.blocks <= 64
        assert layout.channels <= AT.room
        assert (roles.group > 0).all()
        for blocks in (roles.block, roles.twin):
            assert (blocks >= -1).all()
            assert (blocks < layout.blocks).all()
        order, shape = channels.order, (len(channels.ring), layout.channels)
        assert channels.offset_cdeg.shape == channels.ring.shape == order.shape == shape
        assert channels.beam.shape == (len(channels.ring), BEAM.end)
        assert (np.sort(order, axis=1) == np.arange(layout.channels)).all()
        assert ((roles.table >= 0) & (roles.table < len(channels.ring))).all()
        assert ((channels.offset_cdeg >= 0) & (channels.offset_cdeg < 36000)).all()


def beams(
    elevation_rad: ArrayLike,
    *,
    azimuth_cdeg: ArrayLike = 0.0,
    origin_m: tuple[ArrayLike, ArrayLike, ArrayLike] = (0.0, 0.0, 0.0),
    range_m: ArrayLike = 0.0,
    fraction: ArrayLike = 0.0,
) -> Channels:
    """Tables of channels, all arguments (T, C) or of a shape that numpy makes so.

    Args:
        elevation_rad: Above the horizontal plane of the sensor [rad], (T, C); sets the rings: equal
            elevations are one ring.
        azimuth_cdeg: Added to the azimuth of the block, clockwise [0.01°].
        origin_m: Where the beam begins: along it, to its right, above the center [m].
        range_m: Added to every distance [m].
        fraction: Firing time as a fraction of the time from a firing to the next; sets the order.
    """
    elevation = np.atleast_2d(np.asarray(elevation_rad, dtype=np.float64))
    offset = np.broadcast_to(np.asarray(azimuth_cdeg, dtype=np.float64), elevation.shape)
    whole = np.rint(offset)
    _, ring = np.unique(elevation, return_inverse=True)

    rest_rad = np.deg2rad(0.01) * (offset - whole)
    order = np.argsort(np.broadcast_to(fraction, elevation.shape), axis=1, kind="stable")
    numbers = (np.cos(elevation), np.sin(elevation), *origin_m, range_m, fraction, rest_rad)
    beam = np.zeros((len(elevation), len(numbers), AT.room), np.float32)
    for place, column in enumerate(numbers):
        beam[:, place, : elevation.shape[1]] = column
    return Channels(
        beam.reshape(len(elevation), BEAM.end),
        np.ascontiguousarray(whole % 36000, dtype=np.int32),
        ring.reshape(elevation.shape).astype(np.uint8),
        order.astype(np.uintp),
    )


def block_roles(
    blocks: int, *, time_ns: ArrayLike, rows: int = 1, twins: tuple[int, int] | None = None
) -> BlockRoles:
    """One variant: every block is read in order, or every second is the twin of the one before it.

    Args:
        blocks: Blocks of a packet B.
        time_ns: Firing time of each channel of each block that is read [ns], (K, C).
        rows: Blocks of one firing with a return each: rows 0, 1, … of the tables of channels.
        twins: None = a block is all there is; else the places, 0 or 1 in each pair of blocks that
            follow each other, of the first block and of its twin, which wins if both are as
            intense.
    """
    each = 2 if twins else 1
    first, second = twins or (0, -1)
    start = np.arange(0, blocks - each + 1, each, dtype=np.int64)
    time = np.rint(np.asarray(time_ns, dtype=np.float64)).astype(np.int64)
    assert time.shape[0] == len(start)
    return BlockRoles(
        np.array([rows * each], dtype=np.int64),
        (start + first)[None],
        (start + second if twins else np.full(len(start), -1, dtype=np.int64))[None],
        (np.arange(len(start), dtype=np.int64) % rows)[None],
        time[None],
    )


def variants(*roles: BlockRoles) -> BlockRoles:
    """Several variants of packets as one table, in this order."""
    read = max(one.block.shape[1] for one in roles)

    def rows(name: str) -> NDArray[np.int64]:
        missing = 0 if name in ("table", "time_ns") else -1
        parts = []
        for array in (getattr(one, name) for one in roles):
            room = [(0, 0), (0, read - array.shape[1]), *[(0, 0)] * (array.ndim - 2)]
            parts.append(np.pad(array, room, constant_values=missing))
        return np.concatenate(parts)

    group = np.concatenate([one.group for one in roles])
    return BlockRoles(group, *(rows(name) for name in BlockRoles._fields[1:]))


def distances(unit_m: float, settings: IngestSettings) -> Distances:
    """The unit of distances and the limits of the range in it."""
    rounding = np.array([-1e-6, 1e-6])  # so that a limit of 100 m keeps 50000 units of 2 mm
    limits = np.array([settings.min_range_m, settings.max_range_m]) / unit_m + rounding
    least, most = int(np.ceil(limits[0])), int(np.floor(min(limits[1], 1e9)))
    return Distances(np.float32(unit_m), least, most)


@dataclass(frozen=True, slots=True, eq=False)
class SpinningPackets:
    """Data packets that passed the filter and are in order."""

    t_ns: Times
    """Time of the first shot of each packet [ns], non-decreasing, (P,)."""
    payloads: Payloads
    """The packets, (P, size)."""
    variant: NDArray[np.uint8]
    """Row of ``tables.roles`` of each, (P,)."""
    turn_rad: NDArray[np.float32]
    """Turn from a firing to the next in each packet [rad], (P,); empty = the steps of the azimuth
    in the packet tell."""


def spinning_points(
    t_ns: Times,
    payloads: Payloads,
    variant: NDArray[np.uint8],
    *,
    tables: SpinningTables,
    report: ImportReport,
) -> Columns:
    """Points of packets whose azimuths tell how fast the sensor spins; see `points_of`."""
    packets = SpinningPackets(t_ns, payloads, variant, np.zeros(0, dtype=np.float32))
    return points_of(packets, tables=tables, report=report)


def points_of(packets: SpinningPackets, *, tables: SpinningTables, report: ImportReport) -> Columns:
    """Points of packets that passed the filter and are in order; columns of `Shots`.

    Counts ``points``, ``points_no_return`` (shots without an echo, no fault), ``points_near`` and
    ``points_far`` (outside the range limits) and ``azimuth_jumps``.

    Args:
        packets: The packets, and what holds for each of them.
        tables: The sensor.
        report: Takes the counts.
    """
    layout, t_ns, variant = tables.layout, packets.t_ns, packets.variant
    payloads, turn_rad = packets.payloads, packets.turn_rad
    assert not len(t_ns) or layout.first + layout.blocks * layout.block <= payloads.shape[1]
    assert turn_rad.shape in ((0,), t_ns.shape)
    assert not len(variant) or variant.max() < len(tables.roles.group)
    decoded = decode(
        np.ascontiguousarray(payloads),
        np.ascontiguousarray(t_ns),
        variant,
        layout,
        tables.roles,
        tables.channels,
        tables.distances,
        CIRCLE,
        turn_rad,
    )
    return count_points(decoded, report)


def count_points(decoded: Decoded, report: ImportReport) -> Columns:
    """The columns of what a kernel decoded; its counts go into the report."""
    columns, counts = decoded[:5], decoded[5]
    for name, count in zip(_COUNTS, counts.tolist(), strict=True):
        report.count(name, count)
    report.count("points", len(columns[0]))
    return columns
