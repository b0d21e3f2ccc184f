"""Tuning of 2-D odometry."""

from __future__ import annotations

from msgspec import Struct


class CorrelationTuning(Struct, frozen=True, kw_only=True):
    """Correlative search (Olson 2009)."""

    cell_m: float = 0.1
    """Edge of the finest cells [m]."""
    blur_m: float = 0.1
    """Standard deviation of a return around the points of the map [m]."""
    levels: int = 5
    """Number of sizes of cells; each is twice the one before."""
    angle_step_range_m: float = 25.0
    """Points farther from the laser do not limit the step of the rotation [m]."""
    max_points: int = 400
    """Points of a scan that are correlated."""


CORRELATION = CorrelationTuning()


class HectorMatchTuning(Struct, frozen=True, kw_only=True):
    """Scan matching of hector_slam."""

    largest_turn_rad: float = 0.2
    """A step of the yaw is clamped to this [rad]."""
    matched: float = 0.5
    """A return on a cell with a larger probability matches."""


HECTOR = HectorMatchTuning()


class HectorOdometryTuning(Struct, frozen=True, kw_only=True):
    """Odometry of hector_slam."""

    fewest_points: int = 15
    """With fewer returns a scan cannot be matched."""


HECTOR_ODOMETRY = HectorOdometryTuning()


class LineMapTuning(Struct, frozen=True, kw_only=True):
    """Registration of a scan to a local map of lines."""

    max_iterations: int = 30
    """Upper bound on the iterations on each size of cells."""
    converged_m: float = 1e-4
    """Smaller steps have converged [m] …"""
    converged_rad: float = 2e-5
    """… and these [rad]."""
    levels: tuple[float, float] = (4.0, 1.0)
    """Edges of the cells, coarse first, in units of the finest."""


LINE_MAP = LineMapTuning()


class Odometry2dTuning(Struct, frozen=True, kw_only=True):
    """2-D odometry on a sliding local map."""

    fewest_points: int = 15
    """With fewer returns a scan cannot be registered."""
    window_path_m: float = 25.0
    """Extent of the local map beside the ranges [m]."""
    search_score: float = 0.35
    """A search with a lower score has found nothing."""
    widest_search_m: float = 10.0
    """Largest distance from the prediction that is searched [m]."""
    loose_sd_m: float = 0.5
    """A motion less certain than this ends at a keyframe [m]."""
    loose_prior: float = 2.0
    """The prediction has less weight in the registration than its accuracy allows: its errors are
    the same from scan to scan, and would bend the map a little everywhere."""
    first_keyframes: int = 5
    """A local map of fewer keyframes has gaps between the returns: every scan is added to it."""
    reset_after: int = 20
    """Number of scans that are lost one after the other before the local map starts again."""


ODOMETRY_2D = Odometry2dTuning()


class Prediction2dTuning(Struct, frozen=True, kw_only=True):
    """Predicted motion from one scan to the next."""

    velocity_s: float = 0.25
    """The velocity is measured over at least this time, because times of scans jitter [s]."""
    acceleration_m_s2: float = 3.0
    """Standard deviation of the acceleration [m/s²] …"""
    acceleration_rad_s2: float = 4.0
    """… and of that of turns [rad/s²]."""
    long_gap_s: float = 0.7
    """Over longer times without odometry the velocity is not extrapolated [s]."""
    slip: float = 0.05
    """Error of the distance of wheel odometry as a ratio …"""
    turn_slip: float = 0.1
    """… error of its rotation as a ratio …"""
    turn_per_m: float = 0.02
    """… and per distance [rad/m]."""
    imu_rad_s: float = 0.002
    """Drift of the yaw of an IMU [rad/s]."""


PREDICTION_2D = Prediction2dTuning()


class ScanPointTuning(Struct, frozen=True, kw_only=True):
    """The returns of a scan as points."""

    spacing_m: float = 0.05
    """Neighboring returns closer than this have less weight each [m]."""


SCAN_POINTS = ScanPointTuning()


class Observability2dTuning(Struct, frozen=True, kw_only=True):
    """Directions that the lines determine."""

    unobserved_sd_m: float = 1e3
    """Reported for a direction without any information [m]."""


OBSERVABILITY_2D = Observability2dTuning()
