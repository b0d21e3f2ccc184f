"""Tuning of audit and joint calibration."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class AntennaStageTuning(Struct, frozen=True, kw_only=True):
    """The antenna in the stage ``calibration``."""

    aided_sd_factor: float = 3.0
    """True errors against stated ones, of an estimate from a trajectory that the fixes pulled."""


ANTENNA_STAGE = AntennaStageTuning()


class BeamTuning(Struct, frozen=True, kw_only=True):
    """Which LiDARs have beams that can be calibrated."""

    most: int = 64
    """Beams of a LiDAR; more unknowns need more memory than a window has."""
    sampled: int = 5
    """Multiframes in which the rings are looked at."""
    max_spread_rad: float = float(np.deg2rad(0.15))
    """Median deviation of the elevations of a ring: a ring that is no beam has a larger one."""


BEAMS = BeamTuning()


class AuditTuning(Struct, frozen=True, kw_only=True):
    """Audit and calibration of a rig."""

    min_windows: int = 3
    """With fewer windows there is no audit."""
    clearly: float = 1.2
    """How many times the points another mount must put on planes that two LiDARs see."""
    far_rad: float = float(np.deg2rad(2.5))
    far_m: float = 0.1
    far_s: float = 0.05
    """With a larger change from the rig file other mounts are tried too."""
    search_windows: int = 3
    search_window_s: float = 3.0
    """Windows on which mounts are searched from any start: number and length [s]."""


AUDIT = AuditTuning()


class EquationTuning(Struct, frozen=True, kw_only=True):
    """Standard deviations in the normal equations of a window."""

    point_sd_m: float = 0.015
    """Of a point across its plane [m]."""
    grazing: float = 0.15
    """Cosine of the incidence below which a range hardly tells the distance from a plane."""
    knot_sd: tuple[float, float] = (0.05, 0.3)
    """Of a knot's step in one round: rotation [rad], position [m]."""
    chain_sd: tuple[float, float] = (0.0003, 0.001)
    """Without an IMU: change of the correction from knot to knot, rotation [rad], position [m]."""
    bias_sd: tuple[float, float, float] = (0.1, 0.3, 2.0)
    """Biases of gyroscope [rad/s] and accelerometer [m/s²], gravity [m/s²]."""
    gravity_sd_m_s2: float = 0.02
    """Of the length of gravity [m/s²]."""
    fixed: float = 1e8
    """Information of the first knot: a window floats freely, so one pose is fixed."""
    plane_prior: float = 1e-3
    """Information added to that of every plane, so that all are determined."""


EQUATIONS = EquationTuning()


class HeldOutTuning(Struct, frozen=True, kw_only=True):
    """Whether a calibrated rig may be used."""

    few_beams: float = 0.1
    """Part of the parameters of beams that may contradict another part of the walk."""
    not_worse: float = 1.01
    better: float = 0.99
    """Ratio of figures of fit, after against before."""


HELD_OUT = HeldOutTuning()


class ImuRowTuning(Struct, frozen=True, kw_only=True):
    """What the samples of an IMU say in a window."""

    fine: int = 10
    """Samples are integrated this many times between two knots."""
    safety: float = 1.5
    """Noise is taken for this many times as large as it is measured."""
    min_samples: int = 50
    """Fewer samples do not show their noise."""
    eps_rad: float = 1e-4
    eps_s: float = 1e-4
    """Steps of the numerical derivatives [rad], [s]."""
    least_gyro: float = 3e-5
    least_accel: float = 3e-4
    """No IMU on a backpack is better [rad/s/sqrt(Hz), m/s²/sqrt(Hz)]."""


IMU_ROWS = ImuRowTuning()


class JointTuning(Struct, frozen=True, kw_only=True):
    """Joint calibration of mounts, clocks and trajectory."""

    dense_rounds: int = 2
    """Number of the last rounds that use all points; before them a part leads near the solution."""
    min_windows: int = 3
    """Fewer windows do not show how much their estimates scatter."""
    changed: float = 50.0
    """Larger disagreements than errors of beams explain: 120 to 340 with a mount that slips by 2°
    or a clock that jumps by 50 ms in the middle of the walk."""
    sigmas: float = 3.0
    """A change of more standard deviations is no noise."""


JOINT = JointTuning()


class ParameterTuning(Struct, frozen=True, kw_only=True):
    """Priors of parameters, as standard deviations."""

    mean_azimuth_sd_rad: float = 1e-6
    """Of a mean that nothing observes [rad]."""
    mean_range_sd_m: float = 1e-3
    """Of the mean of all beams [m]: of 32 that are wrong by 5 mm."""
    known_sd: float = 1e-9
    """Of a parameter that keeps its value, in its unit."""


PARAMETERS = ParameterTuning()


class PurityTuning(Struct, frozen=True, kw_only=True):
    """Planes without the points of other surfaces."""

    range_sd_m: float = 0.015
    """Of a range [m]."""
    across_sd_m: float = 0.003
    """Of a point across its plane, however oblique: of poses, and of surfaces that are not flat
    [m]."""
    refits: int = 3
    """How many times a plane is fitted to the points that are left."""
    most_sds: float = 3.0
    """A point farther from a plane than this many standard deviations is not on it."""
    least_explained: float = 0.9
    """Part of the points of a cube that must be on a plane."""
    near_face_m: float = 0.05
    """A point so near to the face of a cube may be beyond it by its noise."""


PURITY = PurityTuning()


class CommonPlaneTuning(Struct, frozen=True, kw_only=True):
    """Planes that the LiDARs of a window see together."""

    min_points: int = 12
    """Of one LiDAR in a cube."""
    min_extent_m: float = 0.08
    """Smallest standard deviation of the points along the plane, in the narrower direction [m]."""
    min_facing: float = 0.97
    """Cosine of the largest angle between the normals that two LiDARs see in a cube."""


COMMON_PLANES = CommonPlaneTuning()


class CalibrationWindowTuning(Struct, frozen=True, kw_only=True):
    """A window of the walk."""

    knot_s: float = 0.05
    """Distance in time of the knots of the trajectory's correction [s]."""
    points_of_frame: int = 600
    """Points of one sensor in one multiframe that lead near the solution."""
    margin_ns: int = 100_000_000
    """Samples of the IMU are kept this much longer than the window on both sides [ns]."""
    velocity_s: float = 1e-3
    """Velocities are differences over this time [s]."""
    nearest_m: float = 1e-3
    """A ray has at least this length [m]."""
    most: int = 1200
    enough_windows: int = 24
    """The same where there are few windows; from how many windows on the fewest are enough."""


WINDOWS = CalibrationWindowTuning()
