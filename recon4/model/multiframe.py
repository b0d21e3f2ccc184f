"""Multiframe: the points of all LiDARs during one revolution, on one clock."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

COLUMNS: dict[str, tuple[str, int]] = {
    "xyz": ("<f4", 3),
    "intensity": ("<u2", 1),
    "ring": ("|u1", 1),
    "sensor": ("|u1", 1),
    "echo": ("|u1", 1),
    "dt_ns": ("<i4", 1),
}
"""Column name -> (dtype, width): the layout of points on disk and in memory."""


@dataclass(frozen=True, slots=True, eq=False)
class Multiframe:
    """Points of one revolution, ordered by sensor and within a sensor by firing order."""

    frame_id: int
    """Counts from 0 without gaps within a recording."""
    t_ns: int
    """Start of the frame [ns]; frames follow each other every ``duration_ns``."""
    duration_ns: int
    """Nominal length of the frame [ns] (100 ms at 10 Hz)."""
    xyz: NDArray[np.float32]
    """Points in the frame of their own sensor [m], (N, 3). Finite, never at the origin."""
    intensity: NDArray[np.uint16]
    """Raw intensity as the sensor gave it (Velodyne: 0..255), (N,)."""
    ring: NDArray[np.uint8]
    """Beam of the sensor, 0 = lowest elevation, (N,)."""
    sensor: NDArray[np.uint8]
    """Row in ``Rig.sensors``, (N,)."""
    echo: NDArray[np.uint8]
    """0 = only or strongest return, 1 = further return of the same shot, (N,)."""
    dt_ns: NDArray[np.int32]
    """Time of the shot relative to ``t_ns`` [ns], (N,)."""

    def __len__(self) -> int:
        return len(self.xyz)

    @property
    def t_mid_ns(self) -> int:
        """Middle of the frame [ns]: the time its pose refers to."""
        return self.t_ns + self.duration_ns // 2

    def of_sensor(self, sensor: int) -> Multiframe:
        """The points of one sensor only."""
        return self.take(np.flatnonzero(self.sensor == sensor))

    def take(self, rows: NDArray[np.integer] | slice) -> Multiframe:
        """Some of the points, as a multiframe of the same time."""
        columns = {name: getattr(self, name)[rows] for name in COLUMNS}
        return Multiframe(self.frame_id, self.t_ns, self.duration_ns, **columns)
