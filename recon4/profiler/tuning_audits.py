"""Tuning of audits of rigs with a profiler."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class ClockAuditTuning(Struct, frozen=True, kw_only=True):
    """Whether the clocks of IMU, 2-D laser and profiler agree."""

    most_s: float = 0.25
    """Largest difference that is searched for [s]."""
    step_s: float = 0.005
    """Step of the search [s]."""
    smooth_s: float = 1.0
    """Slower differences of the headings are drift of the gyroscope [s]."""
    min_poses: int = 100
    """Fewer poses of the 2-D laser show no clock."""
    min_swing_rad: float = float(np.deg2rad(0.3))
    """Without turns the headings do not show the clocks."""
    same_ratio: float = 0.8
    """The headings must differ less than this part of what they do as recorded."""
    said_s: float = 0.008
    """Smaller differences are not said: they move a walking body by less than a centimeter [s]."""
    line_points: int = 250_000
    """Points of the profiler that are placed for each difference of the clocks."""
    place_m: float = 0.08
    """Edge of the cubes whose number is compared [m]."""
    clear_ratio: float = 0.98
    """Fewer places than this part of those as recorded show that the clocks differ."""
    line_most_s: float = 0.08
    line_step_s: float = 0.01
    """Largest difference of the profiler's clock that is searched for, and the step [s]."""


CLOCK_AUDIT = ClockAuditTuning()


class MirroredTuning(Struct, frozen=True, kw_only=True):
    """A 2-D laser mounted upside down."""

    apart_ns: int = 200_000_000
    """Scans this far apart are compared [ns]."""
    min_turn_rad: float = float(np.deg2rad(4.0))
    """Pairs between which the body turns less do not vote [rad]."""
    pairs: int = 40
    """Number of pairs that vote."""
    min_pairs: int = 8
    """Fewer pairs decide nothing."""
    most: float = 0.75
    """Part of the pairs that must turn against the gyroscope."""
    search_rad: float = float(np.deg2rad(25.0))
    """Largest turn that is searched [rad]."""
    far_m: float = 30.0
    """Farther returns are not compared [m]."""


MIRRORED = MirroredTuning()


class MountAuditTuning(Struct, frozen=True, kw_only=True):
    """Whether the profiler is mounted as the rig file says."""

    said_rad: float = float(np.deg2rad(0.5))
    """Smaller rotations are not said."""
    said_m: float = 0.03
    """Smaller shifts are not said [m]."""
    cycles: int = 5
    """Number of searches along all axes."""
    clear_ratio: float = 0.98
    """Fewer places than this part of those as mounted show that the mount is another one."""
    step_rad: float = float(np.deg2rad(0.25))
    step_m: float = 0.01
    """Step of the search …"""
    coarse: tuple[float, ...] = (-12.0, -9.0, -6.0, -3.0, 0.0, 3.0, 6.0, 9.0, 12.0)
    fine: tuple[float, ...] = (-2.0, -1.0, 0.0, 1.0, 2.0)
    """… and the changes that are tried along an axis, in steps, coarsely and then finely."""
    coarse_points: int = 40_000
    fine_points: int = 80_000
    """Points that are placed in the coarse search and in the fine one."""
    coarse_m: float = 0.2
    fine_m: float = 0.1
    """Edges of the cubes [m]."""


MOUNT_AUDIT = MountAuditTuning()
