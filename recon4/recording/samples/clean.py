"""Cleans IMU and GNSS samples: sorted, unique, finite, in SI units; all rejects are counted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.model.samples import STANDARD_GRAVITY_M_S2, GnssQuality, GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.report import ImportReport

Samples = TypeVar("Samples", ImuSamples, GnssSamples)

_FASTEST_RAD_S = 12.0
"""Largest sustained turn rate (690 deg/s); beyond it the unit is wrong."""
_LEAST_REPEATED, _MOVING_RAD_S = 10, 0.1
"""Noise changes each sample of a sensor that works. A few equal ones are those of a slower sensor;
at rest they do no harm."""


def join(parts: Sequence[Samples]) -> Samples | None:
    """Concatenate records in the given order; None if there are none."""
    if not parts:
        return None
    return _build(parts[0], lambda name: np.concatenate([getattr(part, name) for part in parts]))


def gather(parts: list[Samples], item: Samples) -> None:
    """Append a record to a list; those of like length at its end become one.

    A capture brings samples one by one: as arrays of their own they would take ten times the
    memory. So there are few arrays, however long it lasts, and each sample is copied log N times.
    """
    parts.append(item)
    while len(parts) > 1 and len(parts[-1]) >= len(parts[-2]):
        last = join(parts[-2:])
        assert last is not None
        parts[-2:] = [last]


def clean_imu(
    imu: ImuSamples, *, offset_s: float, jumps_ns: Sequence[int], report: ImportReport
) -> ImuSamples | None:
    """Sorted, unique and finite samples on the rig's clock; None when nothing is left.

    Args:
        imu: Samples in order of arrival.
        offset_s: Added to their times [s].
        jumps_ns: How far the clock went back in the LiDARs' times: a jump of the IMU like one of
            these is the same jump, and is carried on by the same amount.
        report: Gets the counts ``imu_nan``, ``imu_duplicate``, ``imu_unsorted``, ``imu_repeated``.

    Raises:
        ConfigError: If the angular rates cannot be rad/s.
    """
    imu = _carried_on(imu, jumps_ns, report)
    finite = np.all(np.isfinite(imu.gyro_rad_s), axis=1)
    whole = np.isfinite(imu.accel_m_s2).sum(axis=1)
    finite &= (whole == 3) | (whole == 0)
    report.count("imu_nan", int(np.count_nonzero(~finite)))
    imu = _sorted(_take(imu, finite), offset_s, "imu", report=report)
    imu = _without_repeated(imu, report)
    report.count("imu_kept", len(imu))
    if not len(imu):
        report.warn("no usable IMU sample")
        return None
    _check_rates(imu)
    return _check_gravity(imu, report)


def clean_gnss(gnss: GnssSamples, *, offset_s: float, report: ImportReport) -> GnssSamples | None:
    """Sorted, unique and valid positions on the rig's clock; None when nothing is left."""
    place = np.isfinite(gnss.lat_rad) & np.isfinite(gnss.lon_rad)
    place &= (np.abs(gnss.lat_rad) <= np.pi / 2) & (np.abs(gnss.lon_rad) <= 2 * np.pi)
    report.count("gnss_nan", int(np.count_nonzero(~place)))
    invalid = place & (gnss.quality == GnssQuality.INVALID)
    report.count("gnss_no_fix", int(np.count_nonzero(invalid)))
    gnss = _sorted(_take(gnss, place & ~invalid), offset_s, "gnss", report=report)
    report.count("gnss_kept", len(gnss))
    if not len(gnss):
        report.warn("no usable GNSS position")
        return None
    return gnss


def _build(record: Samples, column: Any) -> Samples:
    return type(record)(**{f.name: column(f.name) for f in fields(record)})


def _take(samples: Samples, rows: NDArray[Any]) -> Samples:
    return _build(samples, lambda name: getattr(samples, name)[rows])


def _sorted(samples: Samples, offset_s: float, kind: str, *, report: ImportReport) -> Samples:
    t_ns = samples.t_ns
    report.count(f"{kind}_unsorted", int(np.count_nonzero(np.diff(t_ns) < 0)))
    order = np.argsort(t_ns, kind="stable")
    new = np.diff(t_ns[order], prepend=np.iinfo(np.int64).min) != 0 if len(order) else order > 0
    report.count(f"{kind}_duplicate", len(order) - int(np.count_nonzero(new)))
    samples = _take(samples, order[new])
    shifted = samples.t_ns + round(offset_s * 1e9)
    return _build(samples, lambda n: shifted if n == "t_ns" else getattr(samples, n))


def _carried_on(imu: ImuSamples, jumps_ns: Sequence[int], report: ImportReport) -> ImuSamples:
    steps = np.diff(imu.t_ns)
    shift: Times = np.zeros(len(imu), np.int64)
    for row in np.flatnonzero(steps < -200_000_000):
        like = [j for j in jumps_ns if abs(j + steps[row]) < 1_000_000_000]
        if like:
            shift[row + 1 :] += like[0]
            report.count("imu_jumps_back")
    return ImuSamples(imu.t_ns + shift, imu.gyro_rad_s, imu.accel_m_s2)


def _without_repeated(imu: ImuSamples, report: ImportReport) -> ImuSamples:
    """Drop what a driver that hangs repeats with new time stamps: a gap is honest."""
    values = np.concatenate([imu.gyro_rad_s, np.nan_to_num(imu.accel_m_s2)], axis=1)
    same = np.all(values[1:] == values[:-1], axis=1)
    moving = np.linalg.norm(imu.gyro_rad_s[1:], axis=1) > _MOVING_RAD_S
    rows = np.flatnonzero(same & moving) + 1
    runs = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)
    runs = [run for run in runs if len(run) >= _LEAST_REPEATED]
    if not runs:
        return imu
    repeated = np.concatenate(runs)
    report.count("imu_repeated", len(repeated))
    longest_s = 1e-9 * max(int(imu.t_ns[run[-1]] - imu.t_ns[run[0] - 1]) for run in runs)
    first_s = 1e-9 * int(imu.t_ns[repeated[0]] - imu.t_ns[0])
    times = "once" if len(runs) == 1 else f"{len(runs)} times"
    report.warn(
        f"the IMU repeats a sample with new time stamps {times}, first {first_s:.1f} s after its "
        f"start, for up to {longest_s:.1f} s: its driver hangs. {len(repeated)} samples dropped"
    )
    return _take(imu, np.delete(np.arange(len(imu)), repeated))


def _check_rates(imu: ImuSamples) -> None:
    speed = np.linalg.norm(imu.gyro_rad_s, axis=1)
    high = float(np.percentile(speed, 90))
    if high > _FASTEST_RAD_S:
        raise ConfigError(
            f"IMU: angular rates must be in rad/s; a tenth of them is above {high:.1f}, "
            f"which would be {np.rad2deg(high):.0f} deg/s: are they in deg/s?"
        )


def _check_gravity(imu: ImuSamples, report: ImportReport) -> ImuSamples:
    force = np.linalg.norm(imu.accel_m_s2, axis=1)
    force = force[np.isfinite(force)]
    if not len(force):
        report.warn("the IMU has no accelerometer: the map is leveled by its floor")
        return imu
    usual = float(np.median(force))
    if 0.8 < usual < 1.25:
        report.count("imu_accel_scaled", len(force))
        report.derive("accelerometer was in g (median length near 1), stored in m/s²")
        return ImuSamples(imu.t_ns, imu.gyro_rad_s, imu.accel_m_s2 * STANDARD_GRAVITY_M_S2)
    if not 7.0 < usual < 13.0:
        report.warn(
            f"accelerometer: median length {usual:.2f}, expected about 9.8 m/s² (gravity included)"
        )
    return imu
