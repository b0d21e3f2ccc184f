"""Clocks of LiDARs that run slow or fast against that of the rig, as the rig file says.

A clock starts with the first measurement that is stamped by it, and has its offset then::

    t_rig = t + offset + rate (t - t_first)

The readers add the offset; this adds the rest. An IMU in a LiDAR is on the clock of that LiDAR.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from recon4.model.derived_kinds import DerivedKind
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.assembly.assembler import moved
from recon4.recording.assembly.shots import Shots
from recon4.recording.openers.request import Item, Recording
from recon4.recording.report import ImportReport


def with_clock_rates(recording: Recording, report: ImportReport) -> Recording:
    """The recording, with the rates of the clocks of its rig corrected.

    Args:
        recording: As its opener gives it.
        report: Receives which clocks are corrected.
    """
    rated = [sensor for sensor in recording.rig.sensors if sensor.clock_rate_ppm]
    for sensor in rated:
        report.derive(
            DerivedKind.CLOCK_CORRECTED, sensor=sensor.name, rate_ppm=sensor.clock_rate_ppm
        )
    if not rated:
        return recording
    return replace(recording, read=_corrected(recording.rig, recording.read))


def _corrected(rig: Rig, read: Callable[[], Iterator[Item]]) -> Callable[[], Iterator[Item]]:
    def items() -> Iterator[Item]:
        clocks = _Clocks(rig)
        return map(clocks.corrected, read())

    return items


class _Clocks:
    """When each clock of a rig started, and what is added to its times."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._first_ns: dict[int, int] = {}
        """Row of a LiDAR -> its first time, without its offset."""
        names = [sensor.name for sensor in rig.sensors]
        self._imu_row = names.index(rig.imu_sensor) if rig.imu_sensor else None

    def corrected(self, item: Item) -> Item:
        """An item at its true times."""
        if isinstance(item, Shots) and len(item):
            offset_ns = self._offset_ns(item.sensor)
            return moved(item, self._later_ns(item.sensor, item.t_ns - offset_ns))
        if isinstance(item, Multiframe) and len(item.xyz):
            row = int(item.sensor[0])  # clouds of files are of one LiDAR
            start_ns = item.t_ns - self._offset_ns(row)
            (later_ns,) = self._later_ns(row, np.array([start_ns])).tolist()
            stretch_ns = np.rint(self._rate(row) * item.dt_ns)
            dt_ns = (item.dt_ns + stretch_ns).astype(item.dt_ns.dtype)
            return replace(item, t_ns=item.t_ns + later_ns, dt_ns=dt_ns)
        if isinstance(item, ImuSamples) and self._imu_row is not None and len(item.t_ns):
            return replace(item, t_ns=item.t_ns + self._later_ns(self._imu_row, item.t_ns))
        return item

    def _offset_ns(self, row: int) -> int:
        return round(1e9 * self._rig.sensors[row].time_offset_s)

    def _rate(self, row: int) -> float:
        """Seconds to add a second."""
        return 1e-6 * self._rig.sensors[row].clock_rate_ppm

    def _later_ns(self, row: int, t_ns: Times) -> Times:
        """By how much times as stamped are too early [ns], (N,)."""
        first_ns = self._first_ns.setdefault(row, int(t_ns.min()))
        return np.rint(self._rate(row) * (t_ns - first_ns)).astype(np.int64)
