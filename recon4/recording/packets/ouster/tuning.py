"""Tuning of the packets of Ouster."""

from __future__ import annotations

from msgspec import Struct

from recon4.units import STANDARD_GRAVITY_M_S2


class OusterAddressTuning(Struct, frozen=True, kw_only=True):
    """Several sensors behind one address."""

    smallest_bytes: int = 1000
    """Data packets are larger, other packets are not."""
    sensors: int = 8
    fewest_ratio: int = 10
    """Sensors behind one address; each sends more than a tenth of the packets."""


SHARED_ADDRESS = OusterAddressTuning()


class OusterColumnTuning(Struct, frozen=True, kw_only=True):
    """What columns of one packet have in common."""

    longest_ns: int = 1_000_000_000
    """No packet lasts longer."""
    pause_ns: int = 150_000_000
    """Over a longer pause columns are not counted by their times."""
    usual_hz: float = 10.0
    """Revolutions a second of a sensor that says nothing."""


OUSTER_COLUMNS = OusterColumnTuning()


class OusterImuTuning(Struct, frozen=True, kw_only=True):
    """What an inertial sample may be."""

    max_accel_m_s2: float = 40 * STANDARD_GRAVITY_M_S2
    max_gyro_rad_s: float = 80.0
    """What the chips can measure, and more."""
    apart_ns: int = 100_000_000
    """Three times of a packet are nearer together."""


OUSTER_IMU = OusterImuTuning()
