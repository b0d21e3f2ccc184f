"""Units of an IMU: radians a second and meters per second squared, recognized by content."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from recon4.geometry.se3 import Array, so3_exp
from recon4.model.import_notes import GYRO_UNIT_ASSUMED
from recon4.model.samples import ImuSamples
from recon4.recording.report import ImportReport
from recon4.units import STANDARD_GRAVITY_M_S2

GyroUnit = Literal["auto", "rad_s", "deg_s"]

FASTEST_RAD_S = 12.0
"""Largest sustained turn rate (690 deg/s); beyond it the unit is wrong."""
_FAST_RAD_S = 3.0
"""A walker turns faster for moments only: faster, the accelerations must agree."""
_ACCEL_UNITS = {"g": STANDARD_GRAVITY_M_S2, "mg": 1e-3 * STANDARD_GRAVITY_M_S2, "cm/s²": 1e-2}
"""Units in which sensors state accelerations, and their m/s²."""
_GRAVITY_M_S2 = (7.0, 13.0)
_CONSTANT = 0.5
_WINDOW_NS = 100_000_000
_LEAST_TURN_RAD = 0.02
_LEAST_WINDOWS = 20
_CLEARLY = 2.0
"""Ratio by which one unit must explain the turns of the vertical better than another."""


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
    if unit == "rad_s" or (unit == "auto" and high <= _FAST_RAD_S):
        return imu
    by_gravity = "" if unit == "deg_s" else _by_vertical(imu)
    if by_gravity == "rad_s":
        return imu
    text = f"IMU: a tenth of its angular rates is above {high:.1f}"
    if unit == "auto" and high > np.rad2deg(FASTEST_RAD_S):
        report.warn(
            f"{text}, too much for rad/s and for deg/s: they are in another unit, the IMU is not "
            "used"
        )
        return None
    if unit == "auto" and high <= FASTEST_RAD_S and not by_gravity:
        # The LiDARs decide: `recon4.findings.witnesses.imu` names it if they do not agree.
        report.count(GYRO_UNIT_ASSUMED, len(imu))
        report.derive(f"{text}: taken as rad/s ({np.rad2deg(high):.0f} deg/s)")
        return imu
    report.count("imu_gyro_scaled", len(imu))
    found = f"; against it: ingest.imu_gyro_unit=rad_s ({text})" if unit == "auto" else ""
    report.derive(f"IMU: angular rates are in deg/s, stored in rad/s{found}")
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
    if _GRAVITY_M_S2[0] < usual < _GRAVITY_M_S2[1]:
        return imu
    # The vertical stays up in a body: of a walker's motion alone nothing is left on average.
    constant = float(np.linalg.norm(accel.mean(axis=0)))
    for unit, scale in _ACCEL_UNITS.items():
        if 0.8 < usual * scale / STANDARD_GRAVITY_M_S2 < 1.25 and constant > _CONSTANT * usual:
            report.count("imu_accel_scaled", len(accel))
            report.derive(f"accelerometer was in {unit} (median length {usual:.3g}), now in m/s²")
            return replace(imu, accel_m_s2=imu.accel_m_s2 * scale)
    report.warn(
        f"accelerometer: median length {usual:.3g}, expected about 9.8 m/s² (gravity included): it "
        "counts as not measured, the map is leveled by its floor"
    )
    return replace(imu, accel_m_s2=np.full_like(imu.accel_m_s2, np.nan))


def _by_vertical(imu: ImuSamples) -> Literal["", "rad_s", "deg_s"]:
    """The unit in which the rates turn the vertical as the accelerations do; empty = unclear."""
    window = (imu.t_ns - imu.t_ns[0]) // _WINDOW_NS
    starts = np.flatnonzero(np.diff(window, prepend=-1))
    counts = np.diff(np.append(starts, len(window)))[:, None]
    gyro, accel = (np.add.reduceat(v, starts) / counts for v in (imu.gyro_rad_s, imu.accel_m_s2))
    up = accel / np.linalg.norm(accel, axis=1, keepdims=True)
    follows = (np.diff(window[starts]) == 1) & np.isfinite(up[1:] + up[:-1]).all(axis=1)
    turn = 1e-9 * _WINDOW_NS * (gyro[1:] + gyro[:-1]) / 2.0
    follows &= np.linalg.norm(turn, axis=1) > _LEAST_TURN_RAD
    if np.count_nonzero(follows) < _LEAST_WINDOWS:
        return ""
    turn, before, after = turn[follows], up[:-1][follows], up[1:][follows]
    rad, deg = (_error(scale * turn, before, after) for scale in (1.0, np.deg2rad(1.0)))
    if rad * _CLEARLY < deg:
        return "rad_s"
    return "deg_s" if deg * _CLEARLY < rad else ""


def _error(turn: Array, before: Array, after: Array) -> float:
    """Median angle between the vertical as turned by the rates and as measured [rad]."""
    turned = np.einsum("nij,nj->ni", so3_exp(-turn), before)
    return float(np.median(np.arccos(np.clip(np.sum(turned * after, axis=1), -1.0, 1.0))))
