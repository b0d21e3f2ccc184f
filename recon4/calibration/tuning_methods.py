"""Tuning of the other methods of calibration, and of what they start from."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class RestTuning(Struct, frozen=True, kw_only=True):
    """Floor normals and gravity while the backpack rests."""

    max_bytes: int = 4 << 20
    """Largest table of inclinations."""
    thickness_m: float = 0.03
    """Points this near to a plane are on the floor [m]."""
    rounds: int = 6
    """Number of fits to the points that are near."""
    min_points: int = 200
    """Fewer points are no floor."""
    min_frames: int = 5
    """Multiframes of a rest."""
    rest_rad_s: float = 0.05
    rest_m_s2: float = 0.1
    """Largest standard deviations of turn rate and force while the backpack rests."""
    below_m: float = 0.3
    flat: float = 0.8
    """A floor is farther below the body than this, and its normal is that near to the body's z."""


RESTS = RestTuning()


class GravityAlignmentTuning(Struct, frozen=True, kw_only=True):
    """IMU against LiDARs by floors and gravity."""

    min_pairs: int = 2
    """Fewer inclinations show no rotation."""
    min_spread: float = 1e-3
    """Smallest second singular value of the mean of ``n g^T``: of less the heading is not
    observable (inclinations of about 2°)."""


GRAVITY_ALIGNMENT = GravityAlignmentTuning()


class LineEntropyTuning(Struct, frozen=True, kw_only=True):
    """Mount and clock of a profiler by the sharpness of the map."""

    cubes_m: tuple[float, float, float] = (0.2, 0.08, 0.05)
    """Edges of the cubes, coarse first [m]."""
    evaluations: int = 250
    """Largest number of maps that are compared in a step."""
    points: int = 100_000
    """Points of the profiler in a map."""
    carrier_m: float = 1.5
    """Nearer points may be on the person who carries the rig [m]."""
    margin_s: float = 0.3
    """Lines this near to the ends of the walk are not used: a clock may move them beyond [s]."""


LINE_ENTROPY = LineEntropyTuning()


class MountSearchTuning(Struct, frozen=True, kw_only=True):
    """Coarse mounts from any start."""

    voxel_m: float = 0.2
    """Edge of the voxels to which scans are thinned [m]."""
    neighbors: int = 12
    """Points from which a normal is computed."""
    source_points: int = 2000
    """Largest number of points of a source."""
    gates_m: tuple[float, ...] = (1.0, 1.0, 0.6, 0.6, 0.4, 0.4, 0.3, 0.2, 0.2, 0.15)
    """Largest distance of a match in each round [m]."""
    inlier_m: float = 0.08
    """Largest distance of an inlier from its plane [m]."""
    ranked: int = 6
    """Number of mounts that are returned: in a small room several seem possible."""


MOUNT_SEARCH = MountSearchTuning()


class PosePairTuning(Struct, frozen=True, kw_only=True):
    """The mount of a sensor from pairs of poses."""

    max_bytes: int = 16 << 20
    """Largest table of poses."""
    unit_tolerance: float = 0.01
    """A quaternion may differ from a unit by this."""
    min_axes: float = 2e-3
    """Of the mean of rotations: the second singular value, 1 if all are alike."""
    outlier_rad: float = 0.1
    outlier_m: float = 0.2
    """Pairs with larger residuals are outliers [rad], [m]."""
    least_noise_rad: float = float(np.deg2rad(0.05))
    vague_rad: float = float(np.deg2rad(0.5))
    least_noise_m: float = 0.001
    vague_m: float = 0.01
    """No tracking is better; a rotation that is known no better is refused."""


POSE_PAIRS = PosePairTuning()


class SliceTuning(Struct, frozen=True, kw_only=True):
    """A slice through a part of the walk."""

    thickness_m: float = 0.2
    """Of the slices that the stage keeps [m]."""
    seconds: float = 6.0
    """Length of the part [s]."""
    max_points: int = 12_000
    """Drawn of each LiDAR."""
    max_kept: int = 3000
    """Kept of each LiDAR for the page of the project."""
    reach_m: float = 6.0
    """Points farther away are not shown [m]."""


SLICES = SliceTuning()


class StartTuning(Struct, frozen=True, kw_only=True):
    """What the IMU's readings say of its axes and units."""

    min_explained: float = 0.9
    """Part of the turning that an IMU explains if it is the right one and only its mount is
    wrong."""
    unit_tolerance: float = 0.1
    """A scale this near to that of a unit is that of the unit."""
    min_seconds: float = 6.0
    """In a shorter walk the accelerations do not cancel out."""
    alone_s: float = 10.0
    """Length of the window that is tracked with the reference LiDAR alone [s]."""
    most_lost: float = 0.1
    """Ratio of multiframes that lost tracking from which on the turns of a trajectory say nothing
    of an IMU: in an open field a hemispherical LiDAR sees 2 % of its shots, and loses half."""
    far_rad: float = float(np.deg2rad(5.0))
    far_s: float = 0.05
    """Smaller errors are found by the joint calibration from the rig file."""
    scale_tolerance: float = 0.02
    force_tolerance: float = 0.04
    """A usual accelerometer has a bias of 1 % of gravity along each axis."""


START = StartTuning()


class MapAlignmentTuning(Struct, frozen=True, kw_only=True):
    """Mounts by registering the maps of single LiDARs."""

    windows: int = 6
    window_s: float = 8.0
    """Windows that are mapped: number and length [s]."""
    scatter_rad: float = float(np.deg2rad(1.5))
    scatter_m: float = 0.1
    """Windows that differ more do not agree."""


MAP_ALIGNMENT = MapAlignmentTuning()


class CalibrationStageTuning(Struct, frozen=True, kw_only=True):
    """The stage ``calibration``."""

    same_rad: float = 0.1
    same_m: float = 0.1
    """Two mounts are the same within this."""


CALIBRATION_STAGE = CalibrationStageTuning()


class TrajectoryPairTuning(Struct, frozen=True, kw_only=True):
    """Mount and clock from two trajectories (docs/explanation/calibration.md)."""

    shortest_s: float = 20.0
    """A shorter walk has too few turns [s]."""
    step_s: float = 0.1
    """From one motion to the next [s]."""
    turn_s: float = 0.5
    """Duration of the rotations that are correlated [s]."""
    motion_s: float = 1.0
    """Duration of a motion: long enough for turns above the noise of a LiDAR odometry, short enough
    for its drift [s]."""
    most_refined_s: float = 0.5
    """How far the correlation may be off [s]."""
    least_turn_deg: float = 1.0
    """Rotation about a second axis that shows the mount [°]."""
    sd_rad: float = 0.02
    """Usual error of a motion [rad]."""
    sd_m: float = 0.05
    """Usual error of a motion [m]."""
    most_rad: float = 0.2
    most_m: float = 0.4
    """A motion that differs by more was lost by one of the two [rad, m]."""
    most_rounds: int = 40
    """Steps of the least squares; trajectories of two walks never settle."""
    least_agreeing: float = 0.5
    """Ratio of motions that must agree."""
    rate_sigmas: float = 3.0
    """A rate of the clock within this many standard deviations of 0 is none."""


TRAJECTORY_PAIR = TrajectoryPairTuning()
