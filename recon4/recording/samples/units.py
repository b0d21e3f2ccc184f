"""Units of an IMU, and of positions, recognized by content."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from recon4.geometry.se3 import Array, so3_exp
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_notes import GYRO_UNIT_ASSUMED
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.recording.report import ImportReport
from recon4.recording.samples.tuning import GNSS_UNITS, IMU_UNITS
from recon4.units import STANDARD_GRAVITY_M_S2

GyroUnit = Literal["auto", "rad_s", "deg_s"]

_ACCEL_UNITS = {"g": STANDARD_GRAVITY_M_S2, "mg": 1e-3 * STANDARD_GRAVITY_M_S2, "cm/s²": 1e-2}
"""Units in which sensors state accelerations, and their m/s²."""


def in_rad_s(imu: ImuSamples, unit: GyroUnit, report: ImportReport) -> ImuSamples | None:
    """Angular rates in rad/s; None if they can be in no known unit.

    A walker turns at 10 to 300 deg/s. As radians a second these would be 600 to 17 000 deg/s. Where
    the numbers alone do not decide, the turns of the vertical in the accelerations do.

    Args:
        imu: In order of time.
        unit: As a setting names it, or ``auto`` = by content.
        report: Gets the counts ``imu_gyro_scaled`` or ``imu_gyro_assumed`` and what was found.
    """
    high = float(np.percentile(np.linalg.norm(imu.gyro_rad_s, axis=1), 90))
    if unit == "rad_s" or (unit == "auto" and high <= IMU_UNITS.fast_rad_s):
        return imu
    by_gravity = "" if unit == "deg_s" else _by_vertical(imu)
    if by_gravity == "rad_s":
        return imu
    if unit == "auto" and high > np.rad2deg(IMU_UNITS.fastest_rad_s):
        report.warn(FindingKind.GYROSCOPE_UNIT, high=high)
        return None
    if unit == "auto" and high <= IMU_UNITS.fastest_rad_s and not by_gravity:
        # The LiDARs decide: `recon4.findings.witnesses.imu` names it if they do not agree.
        report.count(GYRO_UNIT_ASSUMED, len(imu))
        high_deg_s = float(np.rad2deg(high))
        report.derive(DerivedKind.TURNS_UNIT, high=high, high_deg_s=high_deg_s, kept=True)
        return imu
    report.count("imu_gyro_scaled", len(imu))
    by_content = unit == "auto"
    report.derive(DerivedKind.TURNS_UNIT, high=high, converted=True, by_content=by_content)
    return replace(imu, gyro_rad_s=np.deg2rad(imu.gyro_rad_s))


def in_m_s2(imu: ImuSamples, report: ImportReport) -> ImuSamples:
    """Accelerations in m/s²; NaN, with a warning, if their length is that of gravity in no unit.

    Args:
        imu: In order of time; NaN where there is no acceleration.
        report: Gets the count ``imu_accel_scaled`` and what was found.
    """
    accel = imu.accel_m_s2[np.isfinite(imu.accel_m_s2).all(axis=1)]
    if not len(accel):
        return imu
    usual = float(np.median(np.linalg.norm(accel, axis=1)))
    least_m_s2, most_m_s2 = IMU_UNITS.gravity_m_s2
    least_g, most_g = IMU_UNITS.gravity_g
    if least_m_s2 < usual < most_m_s2:
        return imu
    # The vertical stays up in a body: of a walker's motion alone nothing is left on average.
    constant = float(np.linalg.norm(accel.mean(axis=0)))
    for unit, scale in _ACCEL_UNITS.items():
        g = usual * scale / STANDARD_GRAVITY_M_S2
        if least_g < g < most_g and constant > IMU_UNITS.constant * usual:
            report.count("imu_accel_scaled", len(accel))
            report.derive(DerivedKind.FORCES_UNIT, unit=unit, usual=usual)
            return replace(imu, accel_m_s2=imu.accel_m_s2 * scale)
    report.warn(FindingKind.ACCELEROMETER_UNIT, usual=usual)
    return replace(imu, accel_m_s2=np.full_like(imu.accel_m_s2, np.nan))


def in_degrees(gnss: GnssSamples, report: ImportReport) -> GnssSamples:
    """Positions whose latitudes and longitudes were radians where degrees are expected, converted.

    As degrees all of them would lie in the sea south of Ghana.
    """
    lat, lon = np.rad2deg(gnss.lat_rad), np.rad2deg(gnss.lon_rad)
    inside = (np.abs(lat) <= np.pi / 2.0) & (np.abs(lon) <= np.pi)
    if not len(lat) or not inside.all() or np.median(np.hypot(lat, lon)) < GNSS_UNITS.near_zero_deg:
        return gnss
    report.derive(
        DerivedKind.POSITIONS_UNIT,
        lat_rad=float(np.median(lat)),
        lon_rad=float(np.median(lon)),
    )
    return replace(gnss, lat_rad=lat, lon_rad=lon)


def _by_vertical(imu: ImuSamples) -> Literal["", "rad_s", "deg_s"]:
    """The unit in which the rates turn the vertical as the accelerations do; empty = unclear."""
    window = (imu.t_ns - imu.t_ns[0]) // IMU_UNITS.window_ns
    starts = np.flatnonzero(np.diff(window, prepend=-1))
    counts = np.diff(np.append(starts, len(window)))[:, None]
    gyro, accel = (np.add.reduceat(v, starts) / counts for v in (imu.gyro_rad_s, imu.accel_m_s2))
    up = accel / np.linalg.norm(accel, axis=1, keepdims=True)
    follows = (np.diff(window[starts]) == 1) & np.isfinite(up[1:] + up[:-1]).all(axis=1)
    turn = 1e-9 * IMU_UNITS.window_ns * (gyro[1:] + gyro[:-1]) / 2.0
    follows &= np.linalg.norm(turn, axis=1) > IMU_UNITS.least_turn_rad
    if np.count_nonzero(follows) < IMU_UNITS.least_windows:
        return ""
    turn, before, after = turn[follows], up[:-1][follows], up[1:][follows]
    rad, deg = (_error(scale * turn, before, after) for scale in (1.0, np.deg2rad(1.0)))
    if rad * IMU_UNITS.clearly < deg:
        return "rad_s"
    return "deg_s" if deg * IMU_UNITS.clearly < rad else ""


def _error(turn: Array, before: Array, after: Array) -> float:
    """Median angle between the vertical as turned by the rates and as measured [rad]."""
    turned = np.einsum("nij,nj->ni", so3_exp(-turn), before)
    return float(np.median(np.arccos(np.clip(np.sum(turned * after, axis=1), -1.0, 1.0))))
