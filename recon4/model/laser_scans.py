"""Scans of a 2-D laser: a structure of arrays, one row per scan."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.trajectory import Times

Ranges = NDArray[np.float32]
Rows = NDArray[np.integer]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LaserScans:
    """Ranges of a laser that turns in its own x-y plane (x forward, y left, angles around z).

    Each scan has its own number of beams and its own angles: many lasers change them from scan to
    scan. Beam ``m`` of scan ``n`` is measured at ``t_ns[n] + m * time_step_s[n]`` and points to
    ``angle_min_rad[n] + m * angle_step_rad[n]``; the angle counts from x towards y.
    """

    t_ns: Times
    """Absolute time of the first beam of each scan [ns], strictly increasing, (N,)."""
    range_m: Ranges
    """Measured ranges of all scans, one after the other [m], (R,); NaN = no return."""
    start: NDArray[np.int64]
    """Row of the first range of each scan, and at last the number of ranges, (N + 1,)."""
    angle_min_rad: Array
    """Direction of the first beam [rad], (N,)."""
    angle_step_rad: Array
    """Angle between two beams [rad], (N,); negative = the beams turn clockwise."""
    time_step_s: Array
    """Time between two beams [s], (N,); 0 = unknown."""
    range_max_m: float
    """Largest range the sensor reports [m]; readers turn longer ones into NaN."""
    odometry: Array | None = None
    """Poses of the laser by the recording itself, (N, 3): x [m], y [m], yaw [rad]."""

    def __post_init__(self) -> None:
        count = (len(self.t_ns),)
        assert self.start.shape == (len(self.t_ns) + 1,)
        assert self.range_m.shape == (int(self.start[-1]),)
        assert self.angle_min_rad.shape == self.angle_step_rad.shape == count
        assert self.time_step_s.shape == count
        assert np.all(np.diff(self.start) > 0)
        assert np.all(np.diff(self.t_ns) > 0)
        assert self.odometry is None or self.odometry.shape == (len(self.t_ns), 3)

    @staticmethod
    def of_rows(
        t_ns: Times,
        range_m: Ranges,
        *,
        angles: tuple[float, float],
        range_max_m: float,
        time_step_s: float = 0.0,
    ) -> LaserScans:
        """Scans of a laser whose angles never change.

        Args:
            t_ns: As in the record.
            range_m: One row of ranges a scan [m], (N, M).
            angles: First angle and step [rad].
            range_max_m: As in the record.
            time_step_s: Time between two beams [s]; 0 = unknown.
        """
        count, beams = range_m.shape
        return LaserScans(
            t_ns=t_ns,
            range_m=np.ascontiguousarray(range_m, np.float32).reshape(-1),
            start=beams * np.arange(count + 1, dtype=np.int64),
            angle_min_rad=np.full(count, angles[0], np.float64),
            angle_step_rad=np.full(count, angles[1], np.float64),
            time_step_s=np.full(count, time_step_s, np.float64),
            range_max_m=range_max_m,
        )

    def __len__(self) -> int:
        return len(self.t_ns)

    def __getitem__(self, rows: slice | NDArray[np.bool_] | Rows) -> LaserScans:
        chosen = np.arange(len(self))[rows]
        start = np.concatenate([[0], np.cumsum(self.beams[chosen])])
        return LaserScans(
            t_ns=self.t_ns[rows],
            range_m=self._ranges_of(chosen, start),
            start=start,
            angle_min_rad=self.angle_min_rad[rows],
            angle_step_rad=self.angle_step_rad[rows],
            time_step_s=self.time_step_s[rows],
            range_max_m=self.range_max_m,
            odometry=None if self.odometry is None else self.odometry[rows],
        )

    def _ranges_of(self, chosen: Rows, start: NDArray[np.int64]) -> Ranges:
        """Ranges of some scans; without a copy if they follow each other."""
        if len(chosen) and np.all(np.diff(chosen) == 1):
            return self.range_m[self.start[chosen[0]] : self.start[chosen[-1] + 1]]
        return self.range_m[
            np.repeat(self.start[chosen] - start[:-1], np.diff(start)) + np.arange(start[-1])
        ]

    @property
    def beams(self) -> NDArray[np.int64]:
        """Number of beams of each scan, (N,)."""
        return np.diff(self.start)

    @property
    def duration_s(self) -> Array:
        """Time from the first beam of each scan to the end of its last one [s], (N,)."""
        return self.time_step_s * self.beams

    def ranges(self, k: int) -> Ranges:
        """Ranges of scan ``k`` [m], (M,); a view."""
        return self.range_m[self.start[k] : self.start[k + 1]]

    def angles_rad(self, k: int) -> Array:
        """Direction of each beam of scan ``k`` [rad], (M,)."""
        beams = np.arange(self.start[k + 1] - self.start[k])
        return np.asarray(self.angle_min_rad[k] + beams * self.angle_step_rad[k], dtype=np.float64)

    def points(self, k: int) -> Array:
        """The returns of scan ``k`` in the frame of the laser [m], (P, 2)."""
        ranges = self.ranges(k).astype(np.float64)
        seen = np.isfinite(ranges)
        angles = self.angles_rad(k)[seen]
        return ranges[seen, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)

    @property
    def layout(self) -> CodedText:
        """Beams and field of view, for people: ``scans of 452 to 458 beams over 360°``."""
        fewest, most = int(self.beams.min()), int(self.beams.max())
        field_rad = float(np.median(np.abs(self.angle_step_rad) * (self.beams - 1)))
        if fewest == most:
            return CodedText("content-layout", most=most, field_rad=field_rad)
        return CodedText("content-layout-varies", fewest=fewest, most=most, field_rad=field_rad)


def joined_scans(parts: Sequence[LaserScans]) -> LaserScans:
    """Consecutive scans of one laser; with odometry if all parts have it.

    Args:
        parts: At least one.
    """
    odometry = [part.odometry for part in parts if part.odometry is not None]
    ends = np.cumsum([0] + [len(part.range_m) for part in parts])
    starts = [part.start[:-1] + end for part, end in zip(parts, ends[:-1], strict=True)]
    return LaserScans(
        t_ns=np.concatenate([part.t_ns for part in parts]),
        range_m=np.concatenate([part.range_m for part in parts]),
        start=np.concatenate([*starts, ends[-1:]]),
        angle_min_rad=np.concatenate([part.angle_min_rad for part in parts]),
        angle_step_rad=np.concatenate([part.angle_step_rad for part in parts]),
        time_step_s=np.concatenate([part.time_step_s for part in parts]),
        range_max_m=max(part.range_max_m for part in parts),
        odometry=np.concatenate(odometry) if len(odometry) == len(parts) else None,
    )
