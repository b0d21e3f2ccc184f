"""Points from sound Hesai packets: of sensors that spin, and of the AT128 with its mirrors."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels import spinning as kernel
from recon4.kernels.mirrors import Drum, Shape, decode_mirrors
from recon4.kernels.returns import AT
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.packets.family import PacketSensor
from recon4.recording.packets.hesai.angles import Angles
from recon4.recording.packets.hesai.fields import Fields
from recon4.recording.packets.hesai.firing import FiringVariants
from recon4.recording.packets.hesai.layouts import HesaiLayout
from recon4.recording.packets.hesai.mirrors import MirrorTable
from recon4.recording.packets.spinning import (
    Columns,
    SpinningPackets,
    SpinningTables,
    beams,
    count_points,
    distances,
    points_of,
)
from recon4.recording.report import ImportReport
from recon4.units import TURN_CDEG


class SpinningPoints:
    """Points of one sensor that spins.

    The azimuth of a block is that at its stamp (start or end of the block, by model): each channel
    is turned on by its firing time at the speed of the motor, as the manuals tell.
    """

    def __init__(self, firing: FiringVariants, angles: Angles, sensor: PacketSensor) -> None:
        """Prepare the tables of channels."""
        model, layout = firing.model, firing.layout
        self._firing, self._sensor = firing, sensor.without_head()
        # from +x, the azimuth 0 of the kernel, counterclockwise to +y, that of Hesai
        azimuth_cdeg = 100.0 * np.rad2deg(angles.azimuth_rad) - TURN_CDEG // 4
        self._channels = beams(
            np.broadcast_to(angles.elevation_rad, model.firing_us.shape),
            azimuth_cdeg=azimuth_cdeg,
            fraction=model.firing_us / model.step_us,
        )
        self._layout = _kernel_layout(layout)
        self._distances = distances(1e-3 * layout.unit_mm, sensor.settings)
        self._turn_rad = model.speed_rpm * 2.0 * np.pi / 60.0 * 1e-6 * model.step_us
        self._sense = 1.0
        self._tables: SpinningTables | None = None

    def decode(self, t_ns: Times, fields: Fields) -> Shots:
        """Points of sound packets in order of time."""
        report, row = self._sensor.report, self._sensor.row
        key = fields.firing_key()
        self._firing.meet(key)
        variant, third = self._firing.variant[key], self._firing.third[key]
        columns = self._read(t_ns, fields, variant, report=report)
        rows = np.flatnonzero(third != variant)
        if len(rows):
            payloads = _without_repeated(fields.payloads[rows], fields.layout)
            more = self._thirds(t_ns[rows], Fields(payloads, fields.layout), third[rows])
            columns = _merged(columns, more)
        return Shots(row, *columns)

    def _read(
        self, t_ns: Times, fields: Fields, variant: NDArray[np.uint8], *, report: ImportReport
    ) -> Columns:
        turn_rad = self._turned(fields) * self._turn_rad * fields.speed
        packets = SpinningPackets(t_ns, fields.payloads, variant, turn_rad.astype(np.float32))
        return points_of(packets, tables=self._prepared(), report=report)

    def _thirds(self, t_ns: Times, fields: Fields, variant: NDArray[np.uint8]) -> Columns:
        """Third returns that differ from the first two, as further returns."""
        report = ImportReport()
        columns = self._read(t_ns, fields, variant, report=report)
        for name in ("points", "points_near", "points_far"):
            self._sensor.report.count(name, report.counts[name])
        return (*columns[:4], np.ones_like(columns[4]))

    def _prepared(self) -> SpinningTables:
        """Tables of the modes met so far."""
        roles = self._firing.roles
        if roles is None:
            self._firing.meet(np.array([1]))
            return self._prepared()
        if self._tables is None or self._tables.roles is not roles:
            self._tables = SpinningTables(
                layout=self._layout,
                roles=roles,
                channels=self._channels,
                distances=self._distances,
            )
        return self._tables

    def _turned(self, fields: Fields) -> float:
        """1 if the azimuth grows, -1 if the sensor is set to spin the other way round."""
        steps = (np.diff(fields.azimuth_of(0)) + 18000) % 36000 - 18000
        on, back = int((steps > 0).sum()), int((steps < 0).sum())
        if on != back:
            self._sense = 1.0 if on > back else -1.0
        return self._sense


class MirrorPoints:
    """Points of one AT128."""

    def __init__(self, firing: FiringVariants, mirrors: MirrorTable, sensor: PacketSensor) -> None:
        """Prepare the tables of directions."""
        layout, model = firing.layout, firing.model
        self._sensor = sensor.without_head()
        self._shape = Shape(
            blocks=layout.blocks,
            first=layout.blocks_at + layout.azimuth_at,
            block=layout.block_bytes,
            channel_first=layout.returns_at,
            channel=layout.return_bytes,
        )
        self._drum = Drum(
            start=mirrors.start,
            channel=_channel_rows(-_rad(mirrors.azimuth), _rad(mirrors.elevation)),
            azimuth_correction=_rad(mirrors.azimuth_correction.T).astype(np.float32),
            elevation_correction=_rad(mirrors.elevation_correction.T).astype(np.float32),
            ring=np.unique(mirrors.elevation, return_inverse=True)[1].astype(np.uint8),
        )
        self._distances = distances(1e-3 * layout.unit_mm, sensor.settings)
        start_us = model.start_us(layout.blocks)
        self._block_ns = np.rint(1e3 * (start_us - start_us[0])).astype(np.int64)

    def decode(self, t_ns: Times, fields: Fields) -> Shots:
        """Points of sound packets in order of time."""
        decoded = decode_mirrors(
            np.ascontiguousarray(fields.payloads),
            np.ascontiguousarray(t_ns),
            np.minimum(fields.returns, 2),
            self._block_ns,
            self._shape,
            self._drum,
            self._distances,
            kernel.CIRCLE,
        )
        return Shots(self._sensor.row, *count_points(decoded, self._sensor.report))


def _rad(fine: NDArray[np.int64]) -> Array:
    """Angles in 1/25600° as radians, in rows."""
    return np.ascontiguousarray(np.deg2rad(fine / 25600.0))


def _channel_rows(azimuth_rad: Array, elevation_rad: Array) -> NDArray[np.float32]:
    """Rows of `recon4.kernels.mirrors.DrumRows`."""
    rows = np.zeros((4, AT.room), np.float32)
    for row, angle_rad in zip(rows.reshape(2, 2, -1), (azimuth_rad, elevation_rad), strict=True):
        row[:, : len(angle_rad)] = np.cos(angle_rad), np.sin(angle_rad)
    return rows.reshape(-1)


def _kernel_layout(layout: HesaiLayout) -> kernel.Layout:
    return kernel.Layout(
        blocks=layout.blocks,
        channels=layout.channels,
        first=layout.blocks_at,
        block=layout.block_bytes,
        azimuth=layout.azimuth_at,
        channel_first=layout.returns_at,
        channel=layout.return_bytes,
        intensity=2,
        big_endian=False,
        min_step_cdeg=-18000,
        max_step_cdeg=18000,
    )


def _without_repeated(payloads: NDArray[np.uint8], layout: HesaiLayout) -> NDArray[np.uint8]:
    """Packets whose third returns are emptied where they are the first or second one again."""
    payloads = payloads.copy()
    at = layout.returns_at + layout.return_bytes * np.arange(layout.channels)
    for block in range(0, layout.blocks - 2, 3):
        columns = [at + layout.blocks_at + layout.block_bytes * (block + part) for part in range(3)]
        low, high = ([payloads[:, c + byte] for c in columns] for byte in (0, 1))
        same = [(low[2] == low[part]) & (high[2] == high[part]) for part in range(2)]
        for byte in range(2):
            payloads[:, columns[2] + byte] *= ~(same[0] | same[1])
    return payloads


def _merged(one: Columns, other: Columns) -> Columns:
    """Columns of both in order of time."""
    order = np.argsort(np.concatenate([one[0], other[0]]), kind="stable")
    return (
        np.concatenate([one[0], other[0]])[order],
        np.concatenate([one[1], other[1]])[order],
        np.concatenate([one[2], other[2]])[order],
        np.concatenate([one[3], other[3]])[order],
        np.concatenate([one[4], other[4]])[order],
    )
