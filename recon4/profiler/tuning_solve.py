"""Tuning of trajectory and refinement of line scans."""

from __future__ import annotations

from msgspec import Struct


class FusionTuning(Struct, frozen=True, kw_only=True):
    """From IMU and 2-D poses to six degrees of freedom."""

    rounds: int = 8
    """Upper bound on the rounds."""
    small_m: float = 1e-4
    """Smaller steps have converged [m]."""
    height_sd_m: float = 0.15
    """Standard deviation of the height of a walking body on level ground, over a second [m]."""
    tilt_sd_rad: float = 0.1
    """Without an IMU: standard deviation of roll and pitch of a walking body [rad]."""


FUSION = FusionTuning()


class GlobalIcpTuning(Struct, frozen=True, kw_only=True):
    """6D SLAM as published."""

    points: int = 8000
    """Points of a sweep that are paired."""
    min_pairs: int = 50
    """Sweeps with fewer pairs are not joined."""
    small_m: float = 1e-3
    """Smaller steps have converged [m] …"""
    small_rad: float = 2e-4
    """… and these [rad]."""


GLOBAL_ICP = GlobalIcpTuning()


class ImuChainTuning(Struct, frozen=True, kw_only=True):
    """A chain of states joined by IMU samples."""

    velocity_sd: float = 3.0
    """Of a walking body, a weak prior that keeps the chain solvable [m/s]."""
    level_gain: float = 0.15
    """Part of the measured tilt that the first attitudes follow in a second."""
    longest_hole_ns: int = 200_000_000
    """Samples farther apart do not join two states [ns]."""
    rest_s: float = 0.5
    """The first attitude is the mean of the accelerations over this time [s]."""
    gyro_bias_sd: float = 0.02
    accel_bias_sd: float = 0.3
    """Of a bias [rad/s], [m/s²]."""


IMU_CHAIN = ImuChainTuning()


class AtRestTuning(Struct, frozen=True, kw_only=True):
    """When an IMU feels no motion. Of a robot that waits: 0.01 rad/s, 0.02 m/s²."""

    window_s: float = 1.0
    """Time over which the samples are compared [s]."""
    turn_rad_s: float = 0.02
    accel_m_s2: float = 0.06
    """Standard deviations of calm samples, over all axes; who holds a scanner moves more."""
    walk_rad: float = 2e-4
    """Random walk of the attitude at rest [rad/sqrt(s)] …"""
    walk_m: float = 1e-3
    """… and of the position [m/sqrt(s)]."""


AT_REST = AtRestTuning()


class LineRefineTuning(Struct, frozen=True, kw_only=True):
    """Refinement of line scans."""

    block: int = 5
    """Multiframes that are matched before the map is brought up to date."""


LINE_REFINE_STEPS = LineRefineTuning()


class LeveledScanTuning(Struct, frozen=True, kw_only=True):
    """2-D SLAM, leveled by the IMU."""

    floor_sd: tuple[float, float, float] = (0.02, 0.02, 0.004)
    """Smallest standard deviation of x, y [m] and heading [rad]: errors of consecutive scans are
    correlated."""
    min_scans: int = 10
    """Fewer scans are not mapped."""
    near_ns: int = 300_000_000
    """A pose this near in time holds a state [ns]."""


LEVELED_SCANS = LeveledScanTuning()


class PlanarHoldTuning(Struct, frozen=True, kw_only=True):
    """What 2-D SLAM says of the motion between two knots."""

    walk_m: tuple[float, float, float] = (0.02, 0.02, 0.05)
    """Random walk of the error of x, y and z [m/sqrt(s)]; the height is by the IMU."""


PLANAR_HOLD = PlanarHoldTuning()


class PublishedRefineTuning(Struct, frozen=True, kw_only=True):
    """Semi-rigid SLAM as published."""

    neighbor_sd: tuple[float, float] = (0.01, 0.03)
    """Of the difference of two consecutive corrections [rad], [m]."""
    total_sd: tuple[float, float] = (0.2, 1.0)
    """Of a correction [rad], [m]."""
    pair_sd_m: float = 0.05
    """Of the distance of a pair [m]."""
    independent: float = 0.05
    """Fraction of the pairs that counts as independent: neighbors pair alike."""


PUBLISHED_REFINE = PublishedRefineTuning()


class FirstLineTuning(Struct, frozen=True, kw_only=True):
    """The first trajectory of a profiler."""

    first_knot_s: float = 0.05
    """The first trajectory needs no finer knots: the IMU determines what lies between."""
    bridged_ns: int = 2_000_000_000
    """The IMU bridges a silent 2-D laser for this time [ns] …"""
    bridged_without_ns: int = 500_000_000
    """… and constant velocity for this time [ns]."""
    poses_at_once: int = 200
    """Poses that are announced together."""
    silent_s: float = 1.0
    """A 2-D laser that is silent for longer is reported [s]."""


FIRST_LINES = FirstLineTuning()


class SupportTuning(Struct, frozen=True, kw_only=True):
    """What holds each multiframe."""

    around_ns: int = 1_000_000_000
    """A line scan sees one plane of the surroundings: the lines of this time before and after it
    count as well [ns]."""
    least: float = 1e-6
    """Smallest information: a standard deviation of 1 km [1/m²]."""


SUPPORT = SupportTuning()


class SweepGraphTuning(Struct, frozen=True, kw_only=True):
    """6D SLAM of sweeps."""

    counted: int = 4000
    """Points of a sweep whose closest pairs are counted."""
    lost_factor: float = 200.0
    """Factor on the standard deviation of an edge across a time that nothing observes."""


SWEEP_GRAPH = SweepGraphTuning()
