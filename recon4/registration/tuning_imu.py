"""Tuning of what an IMU says of the motion."""

from __future__ import annotations

from msgspec import Struct


class FeltMotionTuning(Struct, frozen=True, kw_only=True):
    """What the accelerometer says of the motion (docs/explanation/odometry.md)."""

    shift_sd_m: float = 0.003
    """Standard deviation of the shift over a multiframe along observed directions [m] …"""
    unknown_m: float = 10.0
    """… and along others, where it is no measurement [m]."""
    pulled_s: float = 1.0
    """Time over which points say the same wrong thing of a weak direction [s]."""
    at_rest_m_s: float = 0.02
    """Standard deviation of the velocity of a body that stands [m/s]."""
    first_sd: tuple[float, float, float] = (2.0, 0.2, 0.1)
    """Standard deviation at first of the velocity [m/s], of the bias and of gravity [m/s²]: the
    odometry was leveled by the same accelerometer."""
    bias_walk: float = 1e-3
    """Random walk of the bias [m/s²/√s]."""
    unfelt_m_s: float = 2.0
    """Standard deviation of the change of the velocity where samples are missing or saturated
    [m/s]."""
    least_sd_m: float = 0.001
    """No motion over a multiframe is known better [m]."""
    longest_gap_ns: int = 50_000_000
    """Samples farther apart do not feel what lies between them [ns]."""
    at_once: int = 2000
    """Multiframes whose samples are integrated at a time: hours have millions of samples."""


FELT = FeltMotionTuning()


class ImuEstimateTuning(Struct, frozen=True, kw_only=True):
    """Which errors of an IMU are faults."""

    most_gain: float = 0.015
    """A larger error of the scale about an axis of the body is a fault …"""
    most_angle_rad: float = 0.012
    """… and a larger angle between the axes of IMU and body …"""
    most_clock_s: float = 0.004
    """… and a larger error of the clock [s] …"""
    sigmas: float = 5.0
    """… if it exceeds this multiple of its standard deviation."""


IMU_ERRORS = ImuEstimateTuning()


class ImuGravityTuning(Struct, frozen=True, kw_only=True):
    """Gravity as an accelerometer measures it."""

    most_m_s2: float = 0.2
    """A larger difference is not the bias of a unit in order, which has a standard deviation of
    half of this [m/s²]."""
    min_s: float = 10.0
    """In a shorter walk the change of the velocity matters too much [s]."""
    speed_ns: int = 500_000_000
    """Velocities at the ends are measured over this time [ns]."""


IMU_GRAVITY = ImuGravityTuning()


class ImuLeverArmTuning(Struct, frozen=True, kw_only=True):
    """A lever arm of an IMU that is wrong (`imu_lever_arm.py`)."""

    least_m: float = 0.1
    """A shorter error costs less than others do [m]."""
    sigmas: float = 5.0
    """It exceeds this multiple of its standard deviation."""
    min_frames: int = 40
    """Fewer multiframes with all samples do not show it."""
    prior_sd: tuple[float, float, float] = (10.0, 0.3, 20.0)
    """Standard deviation of lever arm [m], bias and gravity [m/s²] before the fit."""
    rounds: int = 5
    huber: float = 2.0
    """Residuals beyond this many standard deviations count less."""


IMU_LEVER_ARM = ImuLeverArmTuning()


class GyroAlignmentTuning(Struct, frozen=True, kw_only=True):
    """IMU against LiDARs by their turn rates."""

    min_intervals: int = 20
    """Fewer intervals in which the body turns show nothing."""
    min_rate_rad_s: float = 0.03
    """A body that turns less shows nothing."""
    sure: float = 0.97
    """Left-handed axes must explain this part: any noise makes a sign likely."""
    largest_clock_s: float = 0.5
    clock_step_s: float = 0.005
    """Largest error of the clock that is searched for, and the step of the search [s]."""


GYRO_ALIGNMENT = GyroAlignmentTuning()


class TurnedImuTuning(Struct, frozen=True, kw_only=True):
    """An IMU that is mounted otherwise than its rig says."""

    frames: int = 40
    """Multiframes that the LiDARs track alone."""
    least_explained: float = 0.9
    """A gyroscope whose axes are all that is wrong measures more of the turns than this."""
    sigmas: float = 4.0
    """What is taken for other axes explains more by this many standard deviations: 0.5 to 2.6 in
    right rigs, 19 and more if they are left-handed (docs/explanation/odometry.md)."""
    doubted_sigmas: float = 3.0
    """It is asked where windows of ten multiframes show as many: 0.3 to 2.0 in right rigs."""
    most_sd_rad: float = 0.05
    """A rotation that is known less is not taken: in a walk on one level about one axis [rad]."""
    far_rad: float = 0.05
    """The filter finds a smaller error [rad]."""


TURNED_IMU = TurnedImuTuning()


class ReversedForcesTuning(Struct, frozen=True, kw_only=True):
    """Accelerations with the wrong sign."""

    upside_down_rad: float = 2.0
    """Only a body whose z axis is farther from up, by the accelerometer, is looked at [rad]; on its
    side it is 1.6 away."""
    frames: int = 40
    """Multiframes of a window that the LiDARs track alone."""
    each: int = 2
    """Velocities are measured over this many multiframes."""
    least_knots: int = 6
    """Fewer positions in a window show no motion."""
    least: float = 0.4
    """Forces against the motion are correlated more than this (docs/studies/real-recordings.md)."""


REVERSED_FORCES = ReversedForcesTuning()


class SaturationTuning(Struct, frozen=True, kw_only=True):
    """An IMU at the end of its range."""

    same: float = 1e-4
    """Values that differ by less than this ratio are the same."""
    bridged: int = 20
    """At the ends of a stretch noise leaves the largest value for some samples."""
    least_run: int = 3
    least_samples: int = 5
    """A peak of a motion has one largest sample, a saturated sensor repeats it."""
    distinct: float = 0.5
    """At most this ratio of the samples at the end of a range differ: it has two ends, and noise
    nearby."""
    piled_up: float = 3.0
    """A saturated sensor has at least this many times as many samples at its largest value as one
    step below; the peak of a smooth motion has up to 2.4 times as many."""
    slowest_rad_s: float = 1.5
    weakest_m_s2: float = 14.0
    """No range of an IMU ends below this."""


SATURATION = SaturationTuning()


class ImuMotionTuning(Struct, frozen=True, kw_only=True):
    """The motion by an IMU."""

    as_predicted_m: float = 0.03
    """While it is not known how much usually matches, a frame is sure of its pose if the LiDARs
    move what the IMU predicts by less, and what matches lies as near [m]."""


IMU_MOTION = ImuMotionTuning()


class PredictionTuning(Struct, frozen=True, kw_only=True):
    """Prediction of the motion between two registrations."""

    free_sd: tuple[float, ...] = (0.01, 0.05, 0.3, 0.3)
    """Standard deviation of a state between two scans: turn [rad], place [m], velocity [m/s], turn
    rate [rad/s]."""
    rest_ns: int = 500_000_000
    """The vertical is averaged over samples this near in time [ns]; if there is none, the
    nearest."""
    min_rest_samples: int = 10
    """Fewer samples show no vertical."""
    stopped_m_s2: float = 1.4
    """Least acceleration of who does not stand [m/s²]; the wrong bias and tilt of a body whose
    motion nothing observes look like up to 1.1."""
    most_clock_s: float = 0.1
    """A larger error of the clock is not corrected [s]."""
    kept_ns: int = 60_000_000_000
    """During live capture IMU samples are kept for this time [ns]."""
    saturated_noise: tuple[float, float] = (0.5, 10.0)
    """Noise densities of a gyroscope [rad/s/√Hz] and an accelerometer [m/s²/√Hz] at the end of
    their range: a gyroscope of 250°/s in turns of 330°/s misses 8° in a multiframe."""
    slot_s: float = 0.02
    """Without an IMU the motion is sampled this often [s]."""
    rest_rad_s: float = 0.12
    rest_m_s2: float = 0.3
    rest_m_s: float = 0.1
    """Largest turn rate [rad/s], shaking [m/s²] and speed [m/s] of a person who stands; who walks
    turns by 0.5 rad/s and shakes by 1 m/s² and more."""
    rest_change_m_s: float = 0.005
    """A body whose speed changes by more within half a second, beside the noise, does not stand
    still [m/s]: who stands changes it by 1 to 3 mm/s, who begins to walk by 5, 12, 15, 19 and 70 in
    five multiframes."""
    walked_ns: int = 30_000_000_000
    walk_m_s2: float = 0.8
    """Who stops has walked within this time [ns], and shook by more than this [m/s²]."""
    gain_walk: float = 1e-5
    clock_walk_s: float = 1e-4
    """Random walk of the gyroscope's gain and of the clock of the IMU, per sqrt(s), while they are
    estimated: a clock that drifts by 300 ppm is followed."""
    less_sure_gain: float = 1e-3
    less_sure_clock_s: float = 5e-4
    """Standard deviations that are added to both when a new map is begun: what was found before may
    have come from the map that was lost."""
    beyond_sd: float = 6.0
    """A gain or clock is beyond the expected at this many standard deviations of its prior …"""
    left_ratio: float = 0.25
    """… and this part of it may be left (one standard deviation). With all of it a clock 100 ms
    off settled at 250 ms: steps of a walk repeat."""


PREDICTION = PredictionTuning()
