"""Tuning of the witnesses: from which size on something is found."""

from __future__ import annotations

from msgspec import Struct


class ImuWitnessTuning(Struct, frozen=True, kw_only=True):
    """The IMU against the LiDARs."""

    storey_m: float = 1.0
    """Heights that are wrong by more than this put one storey onto another [m]."""
    upside_down_rad: float = 2.0
    """A body whose z axis is farther from up, by the accelerometer, stands on its head [rad]; on
    its side it is 1.6 away."""
    of_a_bias_m_s2: float = 0.4
    """The bias of a unit in order changes gravity by a quarter of this (standard deviation); more
    is a wrong scale, of which a gyroscope in the same unit shows the half, too [m/s²]."""


IMU_WITNESS = ImuWitnessTuning()


class LoopWitnessTuning(Struct, frozen=True, kw_only=True):
    """Loop closures against the drift."""

    small_m: float = 1.0
    """A larger correction of the odometry is a note [m]."""
    residual_m: float = 0.10
    percentile: int = 95
    """Loop closures of which 5 % have a larger residual contradict the map [m]."""
    held_m: float = 1e-4
    """A move that a map does not follow is noted from here on [m]: the step of its points."""


LOOP_WITNESS = LoopWitnessTuning()


class PlaceWitnessTuning(Struct, frozen=True, kw_only=True):
    """Places that look alike."""

    same_place_s: float = 10.0
    """Ambiguous pairs with less time in between are one place."""


PLACE_WITNESS = PlaceWitnessTuning()


class PlacingWitnessTuning(Struct, frozen=True, kw_only=True):
    """The place on earth."""

    large_s: float = 1.0
    """A larger error of a clock is stated in seconds, with a usual cause [s]."""
    same_s: float = 0.5
    """An error of the clock this near to the seconds between GPS time and UTC is that [s]."""


PLACING_WITNESS = PlacingWitnessTuning()


class PlanarWitnessTuning(Struct, frozen=True, kw_only=True):
    """2-D maps."""

    bridged_s: float = 1.0
    """Two stretches with less than this between them are one [s]."""
    lost_s: float = 0.5
    """Tracking that is lost for a shorter time is bridged by the prediction [s]."""
    lost_ratio: float = 0.02
    """With more scans lost than this ratio a map without odometry must not be used."""
    silent_s: float = 1.0
    """Over a longer time without a scan and without odometry the motion is unknown [s]."""
    crossing_check: float = 0.1
    crossing_bad: float = 0.2
    """Ratio of beams that cross walls: *check* and *do not use*."""
    searched_ratio: float = 0.005
    """More poses than this ratio that only a search found are said."""
    uncertain_m: float = 0.5
    """A position with a larger standard deviation is said [m]."""
    coarse_m: float = 0.25
    """With larger cells walls and doors cannot be distinguished [m]."""
    steep_deg: float = 30.0
    """A laser tilted by more does not see the walls of a plan [°]."""
    long_walk_m: float = 60.0
    """A longer path without any loop closure is not confirmed by anything [m]."""


PLANAR_WITNESS = PlanarWitnessTuning()


class RigWitnessTuning(Struct, frozen=True, kw_only=True):
    """The rig file against the recording."""

    vague_m: float = 0.01
    """A lever arm that is known no better is named [m]."""


RIG_WITNESS = RigWitnessTuning()


class SpeedWitnessTuning(Struct, frozen=True, kw_only=True):
    """The speed of a person on foot."""

    max_speed_m_s: float = 4.0
    """No person who carries a backpack moves faster for a second [m/s]."""
    window_s: float = 1.0
    """The speed is measured over this time [s]."""


SPEED_WITNESS = SpeedWitnessTuning()


class TurnScaleTuning(Struct, frozen=True, kw_only=True):
    """The scale of the gyroscope by registered pairs."""

    fewest: int = 2
    farthest: int = 8
    """Nodes between the ends of a pair: neighbors share multiframes, over more turns drift."""
    least_rad: float = 0.1
    most_rad: float = 2.5
    """Turn between the ends of a pair."""
    min_pairs: int = 8
    """Fewer pairs say nothing."""
    most: float = 0.004
    sigmas: float = 3.5
    """A larger ratio, by more than this multiple of its deviation, is a contradiction."""


TURN_SCALE = TurnScaleTuning()


class WeakDirectionTuning(Struct, frozen=True, kw_only=True):
    """Directions that the LiDAR hardly observes."""

    weak_degeneracy: float = 0.005
    """Files of earlier versions do not state the standard deviation: there a direction counts as
    unobservable below this, as for pairs (`GraphTuning.min_degeneracy`)."""
    unsure_sd_m: float = 0.03
    """As `OBSERVATION.weak_sd_m`, of a registration that did not converge: what it states is too
    small [m]."""
    held_ratio: float = 0.7
    """A multiframe matches the map if its match ratio reaches this part of the median of the
    others."""
    unlimited_m: float = 10.0
    """A larger standard deviation is quoted as above this [m]."""
    bridged_s: float = 1.0
    """Two weak stretches with less than this between them are one [s]."""


WEAK_DIRECTION = WeakDirectionTuning()


class TrackingWitnessTuning(Struct, frozen=True, kw_only=True):
    """Tracking of the odometry."""

    few_lost: float = 0.1
    short_gap_s: float = 2.0
    """Tracking that is lost in no more than this part of the multiframes, and for no longer than
    this, may leave a usable map: if its positions are known in spite of it."""
    min_converged: float = 0.9
    half: float = 0.5
    """Ratio of converged registrations: *check* below the first, *do not use* below the second."""
    far_m: float = 0.10
    """A multiframe that did not converge may be as wrong as it is far from its prediction [m]: at
    most 0.03 in 58 right runs, 0.14 in a field without an IMU that was 19 cm off there."""


TRACKING_WITNESS = TrackingWitnessTuning()


class LaserMissingTuning(Struct, frozen=True, kw_only=True):
    """Line scans without a 2-D laser."""

    rests_ratio: float = 0.95
    """At rest for this part of the time, the first trajectory does not drift."""


LASER_MISSING = LaserMissingTuning()


class ClassCorrectionTuning(Struct, frozen=True, kw_only=True):
    """Corrections of classes by people."""

    told_m: float = 0.05
    """A volume that followed its points farther is named [m]."""


CLASS_CORRECTIONS = ClassCorrectionTuning()
