"""Scans of a 2-D laser whose angles never change, as one row of ranges a scan."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans, Ranges


def rows_of(scans: LaserScans) -> Ranges:
    """Ranges of scans with equal numbers of beams [m], (N, M)."""
    assert len(set(scans.beams.tolist())) == 1
    return scans.range_m.reshape(len(scans), -1)


def with_rows(scans: LaserScans, rows: Array) -> LaserScans:
    """The scans with other ranges [m], (N, M)."""
    return replace(scans, range_m=np.ascontiguousarray(rows, np.float32).reshape(-1))


def with_times(scans: LaserScans, time_step_s: float) -> LaserScans:
    """The scans with a time between two beams [s]."""
    return replace(scans, time_step_s=np.full(len(scans), time_step_s))


def angles_of(scans: LaserScans) -> Array:
    """Directions of the beams of scans that all have the same [rad], (M,)."""
    assert not np.ptp(scans.angle_min_rad) and not np.ptp(scans.angle_step_rad)
    return scans.angles_rad(0)
