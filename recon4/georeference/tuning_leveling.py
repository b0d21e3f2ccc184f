"""Tuning of leveling."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class FloorTuning(Struct, frozen=True, kw_only=True):
    """Leveling by the dominant floor."""

    cell_m: float = 0.4
    """Edge of the cells whose points form a patch [m]."""
    min_points: int = 12
    """A cell with fewer points is no patch."""
    below_m: float = 0.3
    """The floor lies at least this far below the sensor [m]."""
    near_m: float = 8.0
    """Points farther from the sensor are not used [m]."""
    max_tilt_rad: float = np.deg2rad(30.0)
    """The body is tilted by less than this [rad]."""
    flatness_m: float = 0.03
    """Thickness of a patch of floor (standard deviation)."""
    agree_rad: float = np.deg2rad(2.0)
    """Patches whose normals differ by less show the same floor [rad]."""
    min_patches: int = 5
    """Fewer patches are no floor."""
    reach_m: float = 1.0
    step_m: float = 0.015
    """Patches nearer to each other than this are of one plane if their heights differ by less [m]:
    a threshold is 2 cm high, a kerb 8 to 15 cm."""
    max_candidates: int = 500
    """Number of patches whose normal is tried as that of the floor."""


FLOOR = FloorTuning()


class LevelTuning(Struct, frozen=True, kw_only=True):
    """Leveling by INS or accelerometer."""

    window_ns: int = 1_000_000_000
    """Window over which accelerations are averaged [ns]: half a dozen steps of a walk."""
    speed_ns: int = 200_000_000
    """Speed at the border of a window is measured over this time before and after [ns]."""
    window_sd_m_s2: float = 0.1
    """Standard deviation of the mean acceleration of a window [m/s²]."""
    bias_sd_m_s2: float = 0.1
    """Standard deviation of an accelerometer's bias [m/s²]."""
    trim: float = 4.0
    """Residual in robust standard deviations above which a pair is an outlier."""
    min_pairs: int = 3
    """With fewer windows the accelerometer does not level."""


LEVELING = LevelTuning()
