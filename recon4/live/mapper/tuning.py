"""Tuning of the map during a capture."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class FollowerTuning(Struct, frozen=True, kw_only=True):
    """Contents of a capture."""

    most_scans: int = 8
    """Scans that wait for the IMU at most, 0.3 s at 25 Hz."""


FOLLOWER = FollowerTuning()


class GnssWatchTuning(Struct, frozen=True, kw_only=True):
    """GNSS during a capture."""

    fastest_m_s: float = 10.0
    """A faster change of the position is a jump [m/s]."""
    noise_m: float = 10.0
    """Distance between fixes that never counts as a jump."""
    shown_s: float = 30.0
    """A jump is shown for this time [s]."""


GNSS_WATCH = GnssWatchTuning()


class ImuWaitTuning(Struct, frozen=True, kw_only=True):
    """Multiframes that wait for the IMU."""

    max_waiting: int = 3
    """Multiframes that wait at most; an IMU that is later than this or silent is not waited for."""
    sure_ns: int = 10_000_000
    """Samples may be missing for this part at the end of a frame; its motion is extrapolated."""


IMU_WAIT = ImuWaitTuning()


class LastKnownTuning(Struct, frozen=True, kw_only=True):
    """Where the body can be after tracking was lost."""

    fastest_m_s: float = 3.0
    """Speed of somebody who runs with a backpack [m/s]."""
    slack_m: float = 1.0
    """Distance that is always possible: the last multiframes before the loss are inexact."""
    drift_rad_s: float = 0.01
    slack_rad: float = 0.2
    """Error of the turn by a gyroscope: a constant rate, and what it has at once."""
    longest_hole_ns: int = 200_000_000
    """Over a longer time without samples the turn is not known [ns]."""


LAST_KNOWN = LastKnownTuning()


class LatencyTuning(Struct, frozen=True, kw_only=True):
    """Multiframes that are left out."""

    kept: tuple[tuple[int, int], tuple[int, int], tuple[int, int]] = (
        (700_000_000, 2),
        (2_000_000_000, 3),
        (5_000_000_000, 5),
    )
    """Age [ns] -> n: one of n multiframes older than this is mapped."""


LATENCY = LatencyTuning()


class LiveAttitudeTuning(Struct, frozen=True, kw_only=True):
    """Attitude during a capture."""

    gain_per_s: float = 0.15
    """Part of the tilt that is removed per second: the steps of a walk hide the vertical."""
    kept_ns: int = 10_000_000_000
    """Attitudes older than this are dropped [ns]."""
    longest_hole_ns: int = 200_000_000
    """Over a longer time without samples the rotation is not known [ns]."""
    min_upright: float = 0.5
    """Cosine of the largest tilt at the start, 60 degrees."""
    most_silent: int = 100
    """Scans that the attitude waits for at most while the IMU is silent."""
    sure_ns: int = 10_000_000
    """Samples may be missing for this time at the end; the motion is extrapolated [ns]."""


LIVE_ATTITUDE = LiveAttitudeTuning()


class LiveIntensityTuning(Struct, frozen=True, kw_only=True):
    """Intensities during a capture."""

    range_bin_m: float = 2.0
    """Width of a bin of range [m]."""
    ranges: int = 32
    """Number of bins of range."""
    memory: float = 20_000.0
    """Largest weight of the past in a bin [points]."""


LIVE_INTENSITY = LiveIntensityTuning()


class LiveMapTuning(Struct, frozen=True, kw_only=True):
    """The map of a capture."""

    preview_points: int = 6000
    """Points of a multiframe used for the preview."""
    coverage_rays: int = 1500
    """Points of a multiframe used for coverage."""
    summary_every_ns: int = 1_000_000_000
    """Time between two summaries [ns]."""
    search_after: int = 5
    """Number of lost multiframes after which relocalization starts, and between its attempts."""
    loop_within_m: float = 4.0
    """Loop closures are looked for within this distance [m]."""
    loop_walked_m: float = 20.0
    """Distance between stored points of the path; an hour's walk has a few thousand."""
    offset_shown_ns: int = 3_000_000_000
    """An offset of the LiDARs is shown for this time [ns]."""


LIVE_MAP = LiveMapTuning()


class MotionWatchTuning(Struct, frozen=True, kw_only=True):
    """What the motion shows of a rig."""

    sd_rad_s: float = 0.008
    sd_m_s2: float = 0.15
    sd_rad_s2: float = 0.004
    """Rate [rad/s], acceleration [m/s²] and change of rate [rad/s²] that a multiframe is known to,
    as standard deviations of audits of a staircase, a field and a street tell."""
    longest_s: float = 1.0
    """No rate is taken over a longer time between two multiframes [s]; a computer that is too slow
    leaves some out, and shows less of fast motion."""
    still_rad_s: float = 0.05
    still_m_s: float = 0.05
    """A body that moves less stands still [rad/s], [m/s]."""
    enough_rad: float = float(np.deg2rad(0.05))
    enough_m: float = 0.005
    enough_s: float = 5e-4
    """Expected standard deviations below which a calibration finds 0.2°, 1 cm and 5 ms."""


MOTION_WATCH = MotionWatchTuning()


class NoteTuning(Struct, frozen=True, kw_only=True):
    """Recent warnings of the reader."""

    recent_s: float = 10.0
    """Counts of this time are recent [s]."""
    fresh_s: float = 120.0
    """A warning is reported for this time; warnings about clocks until the capture ends."""
    most: int = 20
    """Warnings that are kept."""


NOTES = NoteTuning()


class PlaceIndexTuning(Struct, frozen=True, kw_only=True):
    """Places along the path."""

    keep_every_m: float = 1.0
    """Distance between two places [m]."""
    segments: int = 3000
    """Segments stored per place, up to twice as many: 72 to 144 kB. An hour of walking has 4000
    places, which are in a spill file."""
    around: int = 3
    """Places before and after a place that form its local map."""
    sure_match_ratio: float = 0.5
    sure_degeneracy: float = 0.02
    """Smallest values to accept a view without a prior."""
    levels: int = 2
    """Cells of 0.2 and 0.4 m: hypotheses have this accuracy; coarser planes of few points
    mislead."""
    hypotheses: int = 3
    """Poses that are registered for each place."""
    floor_m: float = 0.9
    ceiling_m: float = 0.8
    """Points between these heights below and above the body count as walls [m]."""


PLACE_INDEX = PlaceIndexTuning()


class PlanMatchTuning(Struct, frozen=True, kw_only=True):
    """Correlation of plans of walls."""

    cell_m: float = 0.25
    """Edge of a cell [m]."""
    cells: int = 128
    """Cells along each side."""
    reach_m: float = 10.0
    """Range of the view; with it map and shift stay within 16 m, so that nothing wraps around."""
    shift_m: float = 5.0
    """Largest shift [m]."""
    yaw_step_rad: float = np.deg2rad(4.0)
    """Step of the headings [rad]."""
    apart_m: float = 1.0
    apart_rad: float = 0.25
    """Hypotheses nearer than this are one [m], [rad]."""


PLAN_MATCH = PlanMatchTuning()


class RecoveryTuning(Struct, frozen=True, kw_only=True):
    """Relocalization."""

    places_tried: int = 16
    places_apart_m: float = 1.5
    """Number and spacing of the nearest places that are tried in turn, one per search."""
    same_m: float = 0.3
    same_rad: float = 0.1
    """Hypotheses nearer than this are the same [m], [rad]."""
    max_score: float = 4.0
    lead: float = 1.5
    """Rooms may look alike: a hypothesis is accepted with a sure score and this lead over the
    next."""
    sure_expected: float = 2.0
    sure_score: float = 3.0
    """A place that was not expected must fit for longer: the true one may not be in the map at
    all."""
    max_seen_through: float = 0.06
    """Largest fraction of a view in the free space of a place that nothing predicted, as in
    ``RecognitionTuning``."""
    missed: float = 0.4
    """Loss of score of the expected place by a view that is not registered, as from behind a
    door."""


RECOVERY = RecoveryTuning()


class ScanMapTuning(Struct, frozen=True, kw_only=True):
    """The map of a 2-D laser."""

    summary_every_ns: int = 1_000_000_000
    """Time between two summaries [ns]."""
    shown_every_ns: int = 100_000_000
    """Scans are added to plan and preview at this interval [ns]: a fast laser sees nothing new."""
    redraw_every_ns: int = 10_000_000_000
    """Plan and preview are made again from corrected keyframes at most this often [ns]; it takes
    0.3 ms a keyframe."""
    rays: int = 400
    """Returns of a scan that are added."""
    laser_value: int = 128
    """Intensity of its points in the preview."""
    fastest_m_s: float = 1.0
    """Speed of a person or robot that is lost [m/s]."""


SCAN_MAP = ScanMapTuning()


class ScanPlaceTuning(Struct, frozen=True, kw_only=True):
    """Places along the path of a 2-D laser."""

    most_returns: int = 400
    """Returns of a keyframe that are stored, 5 kB: an hour of walking has 20 000 keyframes."""
    least_drift_m: float = 0.3
    most_drift_m: float = 6.0
    """Drift that is searched, at least and at most [m]."""
    most_drift_rad: float = 0.6
    """Largest drift of the heading that is searched [rad]."""


SCAN_PLACES = ScanPlaceTuning()


class ScanTrackerTuning(Struct, frozen=True, kw_only=True):
    """2-D odometry of a capture."""

    kept_ns: int = 300_000_000
    """Scans of this time before the newest one give the velocity [ns]."""
    least: int = 2
    most: int = 100
    """Scans that are kept."""


SCAN_TRACKER = ScanTrackerTuning()


class ShownTuning(Struct, frozen=True, kw_only=True):
    """The path that is shown."""

    path_step_m: float = 0.25
    """Distance between two of its points [m]."""
    recent_ns: int = 10_000_000_000
    """What was left out is counted over this time [ns]."""


SHOWN = ShownTuning()


class SweptLineTuning(Struct, frozen=True, kw_only=True):
    """Line scans during a capture."""

    preview_points: int = 2500
    """Points of a multiframe used for the preview."""
    coverage_rays: int = 1500
    """Points of a multiframe used for coverage."""
    knot_ns: int = 10_000_000
    """Lines are placed by poses at this interval [ns]."""
    kept_poses: int = 500
    """Poses that are kept."""
    longest_hole_ns: int = 500_000_000
    """Lines in a longer time without a pose are not placed [ns]."""
    most_waiting: int = 30
    """Multiframes that wait for poses at most, 3 s."""


SWEPT_LINES = SweptLineTuning()


class LiveTrackerTuning(Struct, frozen=True, kw_only=True):
    """Odometry of a capture."""

    tried_frames: int = 20
    """Number of recent multiframes of an IMU check, and between two checks."""
    bad_frames: int = 8
    """Number of them, lost or with a large residual, that starts a check."""
    far_m: float = 0.08
    """A larger residual [m]."""
    moved_m: float = 0.003
    """LiDARs that move what the IMU predicts by more in most of them doubt its axes [m]: up to
    0.8 mm in five right walks, 4 to 23 mm with axes that are 10° and more off."""
    still_lost: int = 4
    """Number of them that may still be lost by the IMU that a check chose."""
    early_frames: int = 100
    """If the IMU is rejected before this multiframe, the map made with it is reset."""
    interrupted_ns: int = 2_000_000_000
    """Duration of a pause after which the pose is unknown, unless the IMU continued."""


LIVE_TRACKER = LiveTrackerTuning()
