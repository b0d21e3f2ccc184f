"""Tuning of samples of IMUs and GNSS receivers."""

from __future__ import annotations

from msgspec import Struct

from recon4.units import SECOND_NS


class ImuUnitTuning(Struct, frozen=True, kw_only=True):
    """In which unit an IMU writes (`units.py`)."""

    fastest_rad_s: float = 12.0
    """Largest sustained turn rate (690 deg/s); beyond it the unit is wrong."""
    fast_rad_s: float = 3.0
    """A walker turns faster for moments only: faster, the accelerations must agree."""
    gravity_m_s2: tuple[float, float] = (7.0, 13.0)
    """Median lengths of accelerations in m/s² …"""
    gravity_g: tuple[float, float] = (0.8, 1.25)
    """… and in g."""
    constant: float = 0.5
    """The mean of accelerations in g is at least this part of their length: gravity does not turn
    with the body."""
    window_ns: int = 100_000_000
    """Turns of the vertical are compared over this time [ns]."""
    least_turn_rad: float = 0.02
    """Smaller ones say nothing [rad]."""
    least_windows: int = 20
    clearly: float = 2.0
    """Ratio by which one unit must explain the turns of the vertical better than another."""


IMU_UNITS = ImuUnitTuning()


class RepeatedTuning(Struct, frozen=True, kw_only=True):
    """Samples that are copies of those before (`clean.py`)."""

    least_repeated: int = 10
    moving_rad_s: float = 0.1
    """Noise changes each sample of a sensor that works. A few equal ones are those of a slower
    sensor; at rest they do no harm."""
    least_stuck: int = 50
    """The same of accelerations alone, which some drivers repeat for a faster gyroscope."""


REPEATED = RepeatedTuning()


class BurstTuning(Struct, frozen=True, kw_only=True):
    """Stamps of samples that come in bursts (`bursts.py`)."""

    fewest: int = 50
    """Fewer samples show no rate."""
    longest_ns: int = 2_000_000_000
    """A longer step is a pause or a jump of the clock, and says nothing of the rate; stamps in
    whole seconds are 1 s apart."""
    short: float = 0.2
    """Stamps nearer than this part of the mean step are of one burst."""
    least: float = 0.4
    """Part of the steps that are so short: of stamps that scatter like arrivals, a fifth are."""
    pause: float = 1.5
    """After a pause, samples of a burst are at most this many usual steps apart."""


BURSTS = BurstTuning()


class MeasuredSampleTuning(Struct, frozen=True, kw_only=True):
    """Samples that were not measured (`measured.py`)."""

    least_samples: int = 50
    """Noise changes each sample of a sensor that works. Fewer equal ones may be of a body at
    rest."""
    least_fixes: int = 10
    longest_hole_ns: int = 50_000_000
    """Accelerations are interpolated over a shorter time: a body shakes slower."""
    least_forces: float = 0.5
    """An accelerometer is used if this part of the gyroscope's samples has accelerations."""
    at_zero_rad: float = 1e-8
    """Nobody walks within 6 cm of latitude 0, longitude 0: receivers write it when they have no
    fix."""


MEASURED = MeasuredSampleTuning()


class GnssUnitTuning(Struct, frozen=True, kw_only=True):
    """The unit of latitudes and longitudes (`units.py`)."""

    near_zero_deg: float = 0.05
    """Simulators begin at latitude 0, longitude 0; 5 km further out these are radians [°]."""


GNSS_UNITS = GnssUnitTuning()


class NmeaTuning(Struct, frozen=True, kw_only=True):
    """Sentences of GNSS receivers (`datagrams.py`)."""

    utc_within_ns: int = 5 * SECOND_NS // 2
    """Largest difference between an NMEA time and its arrival at which the time is used."""
    lasts_ns: int = 3 * SECOND_NS
    """A GST sentence holds for the fixes of this time; after a GGA sentence, RMC sentences of this
    time, which have no heights, are left out [ns]."""


NMEA = NmeaTuning()


class HeightTuning(Struct, frozen=True, kw_only=True):
    """Heights above the ellipsoid or the geoid (`heights.py`)."""

    spread_m: float = 2.0
    """Differences of heights of two sources spread less if they are a geoid separation [m]."""
    near_ns: int = 600_000_000
    """Fixes of two sources are compared if they are nearer in time [ns]."""
    least: int = 5
    """Fixes that are compared."""


HEIGHTS = HeightTuning()


class CarriedOnTuning(Struct, frozen=True, kw_only=True):
    """Jumps of the IMU's times with those of another clock (`clean.py`)."""

    least_ns: int = 200_000_000
    """Larger steps are looked at [ns]."""
    back_ns: int = 1_000_000_000
    """A step back this near to a known jump is that one [ns]: nothing else makes it."""
    ahead_ns: int = 200_000_000
    """As much for a step ahead, which may be a pause [ns]."""


CARRIED_ON = CarriedOnTuning()
