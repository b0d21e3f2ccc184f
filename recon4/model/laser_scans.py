"""Scans of a 2-D laser: a structure of arrays, one row per scan."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times

Ranges = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LaserScans:
    """Ranges of a laser that turns in its own x-y plane (x forward, y left, angles around z).

    Beam ``m`` of scan ``n`` is measured at ``t_ns[n] + m * time_step_s`` and points to
    ``angle_min_rad + m * angle_step_rad``; the angle counts from x towards y.
    """

    t_ns: Times
    """Absolute time of the first beam of each scan [ns], strictly increasing, (N,)."""
    range_m: Ranges
    """Measured ranges [m], (N, M); NaN = no return."""
    angle_min_rad: float
    """Direction of the first beam [rad]."""
    angle_step_rad: float
    """Angle between two beams [rad]; negative = the beams turn clockwise."""
    range_max_m: float
    """Largest range the sensor reports [m]; readers turn longer ones into NaN."""
    time_step_s: float = 0.0
    """Time between two beams [s]; 0 = unknown."""
    odometry: Array | None = None
    """Poses of the laser by the recording itself, (N, 3): x [m], y [m], yaw [rad]."""

    def __post_init__(self) -> None:
        assert self.range_m.shape == (len(self.t_ns), self.range_m.shape[1])
        assert np.all(np.diff(self.t_ns) > 0)
        assert self.odometry is None or self.odometry.shape == (len(self.t_ns), 3)

    def __len__(self) -> int:
        return len(self.t_ns)

    def __getitem__(self, rows: slice | NDArray[np.bool_] | NDArray[np.integer]) -> LaserScans:
        odometry = None if self.odometry is None else self.odometry[rows]
        return replace(self, t_ns=self.t_ns[rows], range_m=self.range_m[rows], odometry=odometry)

    @property
    def angles_rad(self) -> Array:
        """Direction of each beam [rad], (M,)."""
        beams = np.arange(self.range_m.shape[1])
        return np.asarray(self.angle_min_rad + beams * self.angle_step_rad, dtype=np.float64)

    def points(self, k: int) -> Array:
        """The returns of scan ``k`` in the frame of the laser [m], (P, 2)."""
        ranges = self.range_m[k].astype(np.float64)
        seen = np.isfinite(ranges)
        angles = self.angles_rad[seen]
        return ranges[seen, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)

    def beam_offsets_s(self, k: int) -> Array:
        """Time of each return of scan ``k`` after its first beam [s], (P,)."""
        beams = np.flatnonzero(np.isfinite(self.range_m[k]))
        return np.asarray(beams * self.time_step_s, dtype=np.float64)
