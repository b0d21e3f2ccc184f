"""Tuning of motion and tracking."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class AidingTuning(Struct, frozen=True, kw_only=True):
    """Fixes of GNSS/INS as measurements of odometry."""

    max_gap_ns: int = 300_000_000
    """No position is interpolated between two fixes farther apart than this [ns]."""
    outage_ns: int = 1_000_000_000
    """Over so long the motion of a walker is predicted [ns]. Fixes that begin later than this do
    not say where an odometry began, nor do those after such a gap go on in its frame."""
    outlier_sd: float = 3.0
    """Residual in standard deviations at which a fix has half its weight."""


AIDING = AidingTuning()


class BridgeTuning(Struct, frozen=True, kw_only=True):
    """Where a scan lies after a gap (docs/explanation/odometry.md)."""

    tried_every_ns: int = 500_000_000
    """While tracking is lost a bridge is searched this often [ns]; it takes half a second of
    work."""
    scans: int = 8
    """Number of the last scans that the new one is compared with."""
    least_ratio: float = 0.28
    """Least ratio of the points of the new scan on surfaces of the last ones. On 42 steps of up to
    8 m it was 0.30 to 0.80, on 60 pairs of places that do not overlap 0.04 to 0.34."""
    rival_ratio: float = 0.75
    """Another pose with this part of the best ratio makes the best one unsure."""
    most_seen_through: float = 0.2
    """Largest ratio of points in the free space of the other view: 0.15 and less on the steps, 0.16
    and more on the others."""
    least_degeneracy: float = 0.05
    """Least eigenvalue of the mean of n n^T: 0.086 and more on the steps."""
    apart_m: float = 0.3
    apart_rad: float = 0.26
    """The joined scans were taken this far apart, or turned by this."""
    rival_m: float = 1.0
    rival_rad: float = 0.2
    """Poses nearer to each other are the same."""
    sd_rad: float = 0.035
    sd_m: float = 0.15
    """Standard deviations of a bridge; steps of NCLT were wrong by 5 cm in the median, at most by
    30 cm and 2°."""


BRIDGE = BridgeTuning()


class ClocksSetTuning(Struct, frozen=True, kw_only=True):
    """Gaps in which only the clocks moved on (`clock_jumps.py`)."""

    least_s: float = 2.0
    """A shorter gap is one [s]: in its time a body hardly leaves the place."""
    most: int = 20
    """Gaps of a recording that are looked at."""
    frames: int = 4
    """Multiframes on both sides by which the motion is measured."""
    enough: float = 0.5
    """A multiframe with this part of the points of the one beside it tells its place."""
    least_ratio: float = 0.5
    """Of the points that match, from one multiframe to the next."""
    moving_m_s: float = 0.25
    turning_rad_s: float = 0.5
    """A slower body may have waited at its place."""
    faster: float = 1.5
    """Steps of a walker change his speed by this ratio …"""
    off_m: float = 0.1
    off_rad: float = 0.1
    """… and this is added to where he may be beyond the gap."""


CLOCKS_SET = ClocksSetTuning()


class PlacedTuning(Struct, frozen=True, kw_only=True):
    """Clouds that are in the frame of a map already (`placed_clouds.py`)."""

    apart: int = 10
    """Multiframes from the first to the second one of a pair."""
    pairs: int = 12
    least_pairs: int = 4
    """This many pairs must show it …"""
    most_others: int = 1
    """… and at most this many may show a sensor that moves."""
    least_m: float = 0.15
    """The middle of the view moves by this in a pair that counts [m]."""
    still_m: float = 0.08
    still_rad: float = 0.02
    """Scans fit without a motion if the best pose is this near to none: up to 0.063 m and 0.0076
    in clouds that were placed by the truth, 0.7 m and more in those of the sensor."""
    least_ratio: float = 0.5
    """Of the points that match."""
    least_degeneracy: float = 0.05
    """As of a bridge: along a corridor any motion fits."""
    cell_deg: float = 1.0
    """Edge of the cells of directions from the origin [°] …"""
    least_met: int = 4
    """… that have this many points in a second …"""
    nearest_m: float = 0.5
    """… which are not of the carrier [m]."""
    behind: float = 1.2
    behind_m: float = 0.5
    """In a cell surfaces lie behind each other if the farthest point is this much farther."""
    least_change: float = 0.1
    """The fraction of these cells changes by this: in simulated walks by 0.00 to 0.04 for LiDARs
    that stand (also Livox, in a forest, beside traffic), by 0.19 to 0.55 in placed clouds."""


PLACED = PlacedTuning()


class CarrierTuning(Struct, frozen=True, kw_only=True):
    """What is known of a carrier's motion before any scan."""

    speed_sd_m_s: float = 1.5
    """Standard deviation of the speed of a carrier, each axis [m/s]."""
    speed_s: float = 10.0
    """Time over which a speed is forgotten [s]; it changes by 0.2 m/s in a tenth of a second."""
    least_sd_m: float = 0.002
    """No motion is expected more closely than this [m] …"""
    turn_sd_rad_s: float = 2.0
    """Standard deviation of the turn rate of a carrier [rad/s]. A tunnel looks the same forward and
    back: nothing else keeps a scan from being turned over."""
    least_sd_rad: float = 0.02
    """… and this [rad]."""
    heavy: float = 3.0
    """Distance in standard deviations from which a motion is implausible."""


CARRIER = CarrierTuning()


class MovingStartTuning(Struct, frozen=True, kw_only=True):
    """Velocity of a body that moves when the recording begins."""

    moving_m_s: float = 0.3
    """A slower body is taken for one that stands [m/s]."""
    sd_m_s: float = 0.2
    """Standard deviation of the velocity between two scans, or two fixes: their errors are
    correlated over seconds [m/s]."""
    longest_ns: int = 300_000_000
    """Frames that are farther apart do not show the velocity of the first [ns]."""


MOVING_START = MovingStartTuning()


class StillTuning(Struct, frozen=True, kw_only=True):
    """Zero-velocity update without an IMU."""

    scans_m: float = 0.01
    """While stationary two consecutive scans agree to this [m] …"""
    scans_rad: float = 0.0035
    """… and this [rad]."""
    chi2: float = 1.0
    """The body is stationary if the best motion reduces chi-square by less than this.
    Measured at rest: up to 0.6; 4 mm or 0.1° of true motion exceed it."""


STILL = StillTuning()


class WeakMotionTuning(Struct, frozen=True, kw_only=True):
    """Motion along a direction that the LiDAR hardly observes."""

    weak_sd_m: float = 0.06
    """Deviation of a position by the points of one multiframe at which half of the error remains
    [m]. Measured on walks with known truth: up to 2 cm the motion of half a second is wrong by 2
    mm, at 5 cm by 0.1 m, above 10 cm by 0.25 m (``docs/studies/covariances.md``)."""
    speed_m_s: float = 0.6
    """Standard deviation of the speed along a direction that nothing but the IMU knows [m/s]."""
    free_speed_m_s: float = 2.0
    """The same if there is no IMU: the registration of scans may slide either way [m/s]."""
    walking_m_s: float = 1.5
    """Motion along such a direction that is faster than a person walks is an error [m/s]."""


WEAK_MOTION = WeakMotionTuning()


class WeakTurnTuning(Struct, frozen=True, kw_only=True):
    """Turns that only the gyroscope holds."""

    weak_sd_m: float = 0.02
    """Deviation by the points of one multiframe at their typical distance, above which the turn is
    not observed [m]: at most 0.012 in offices, staircases, corridors and forests (95 %), 0.025 to
    0.036 in a round hall."""
    bridged_s: float = 1.0
    """Two stretches with less than this between them are one [s]."""
    rate_sd_rad_s: float = float(np.deg2rad(0.2))
    """Standard deviation of a turn rate that only a gyroscope measures, whose bias such
    surroundings do not show, either [rad/s]: 0.22° a second were measured."""
    free_rate_sd_rad_s: float = float(np.deg2rad(2.0))
    """The same without a gyroscope."""
    upright: float = 0.5
    """Cosine to the vertical of an axis below which gravity holds the turn about it."""


WEAK_TURNS = WeakTurnTuning()


class TrackingTuning(Struct, frozen=True, kw_only=True):
    """When a new map is trusted."""

    trusted_frames: int = 30
    """If a new map is lost before this many frames, the state it began with was wrong."""


TRACKING = TrackingTuning()


class LostTuning(Struct, frozen=True, kw_only=True):
    """When tracking is lost."""

    usual_frames: int = 50
    """Number of frames from which the usual match ratio is learned."""
    usual_part: float = 0.8
    """With this part of it a frame lies on the local map …"""
    usual_scan_ratio: float = 0.4
    """… if it shares this part of what scans usually share with the one before."""


LOST = LostTuning()


class GapTuning(Struct, frozen=True, kw_only=True):
    """Gaps between frames."""

    interrupted_ns: int = 2_000_000_000
    """Longest gap between two frames that is predicted across without an IMU [ns]."""


GAPS = GapTuning()


class DenseTuning(Struct, frozen=True, kw_only=True):
    """The dense trajectory."""

    step_ns: int = 9_000_000
    """Poses of the dense trajectory are at least this far apart [ns] (at most about 100 Hz)."""
    most_turn_rad: float = 2e-3
    most_shift_m: float = 5e-3
    """A larger jump from one multiframe to the next is a contradiction, and stays where it is."""
    block: int = 8192
    """Steps of a walk, and their dense poses, in one piece of memory (6 and 9 MB)."""


DENSE = DenseTuning()


class ScanMotionTuning(Struct, frozen=True, kw_only=True):
    """The motion by registering scans."""

    unseen_ns: int = 200_000_000
    """Least time without a frame in which the body moved unseen [ns]. Without such a gap a scan
    that is lost shows a change of what stands around: the doors of an elevator that opened
    elsewhere."""


SCAN_MOTION = ScanMotionTuning()


class HypothesisTuning(Struct, frozen=True, kw_only=True):
    """What a walk may assume."""

    most_walks: int = 6
    """How often a recording is tracked at most, from its import to its map: once is kept for a rig
    that the calibration changes, and with fixes once for the calibration of the antenna, without
    them."""


HYPOTHESES = HypothesisTuning()


class ReportedPoseTuning(Struct, frozen=True, kw_only=True):
    """Poses that a run announces."""

    every: int = 5
    """One pose of this many multiframes is announced …"""
    at_once: int = 4
    """… this many at once."""


REPORTED_POSES = ReportedPoseTuning()


class RideTuning(Struct, frozen=True, kw_only=True):
    """Rides that the IMU feels and no LiDAR sees."""

    knot_s: float = 0.5
    """Accelerations are compared over this time [s]."""
    min_knots: int = 12
    """In a shorter walk the bias is not known."""
    push_m_s2: float = 0.12
    push_sigmas: float = 5.0
    """A push is larger than this, and than this multiple of the usual difference."""
    push_m_s: float = 0.25
    """It changes the speed by at least this."""
    slow_push_m_s2: float = 0.03
    slow_push_sigmas: float = 8.0
    """The same of a slow lift."""
    slow_push_m_s: float = 0.06
    """The same of a slow lift, if an opposite push follows while the body stays in one place."""
    car_m: float = 1.0
    """A person in the car of a lift moves by at most this from the middle [m]."""
    reliable_m_s2: float = 0.06
    """With a larger usual difference rides are not distinguished from errors of IMU and
    trajectory."""
    contradiction_m_s2: float = 0.1
    contradiction_s: float = 2.0
    """A difference above the first contradicts the heights, if it lasts for the second. On walks
    with known truth it is 0.003 to 0.04."""
    sharp_m_s2: float = 0.2
    sharp_sigmas: float = 5.0
    """A single difference above this, and this multiple of the usual one, contradicts the heights,
    too: the odometry changed its vertical speed by 0.1 m/s at once, and the IMU did not feel it. In
    29 walks that were right it was at most 0.03, and 0.16 where one began in motion; 0.24 to 0.46
    where the odometry followed a lift two thirds of its way."""
    bias_sd_m_s2: float = 0.1
    bias_noise_m_s2: float = 0.01
    bias_rounds: int = 10
    """Bias of an accelerometer, usual difference beside it, and rounds of its fit."""
    bridged_knots: int = 2
    """This many knots below the limit do not end a push."""
    same_ride_s: float = 3.0
    """Stretches with no longer break between them are one: the speed that the first has built up
    carries on through the break."""
    whole: float = 0.8
    """Part of the samples of a knot without which it lies at a gap of the IMU."""
    balance: float = 0.4
    """The changes of the speed at both ends of a ride cancel out but for this ratio."""
    longest_s: float = 120.0
    """Two pushes farther apart are no ride [s]."""
    unknown_ride_m: float = 3.0
    """A ride of which the end, or the begin, was not recorded [m]."""


RIDES = RideTuning()
