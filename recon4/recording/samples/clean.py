"""Cleans IMU and GNSS samples: sorted, unique, finite, in SI units; all rejects are counted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.clocks.set_back import going_on, say_set_back
from recon4.recording.clocks.stamps import strays
from recon4.recording.report import ImportReport
from recon4.recording.samples.bursts import first_of_bursts, without_bursts
from recon4.recording.samples.measured_channels import imu_channels, with_forces, without_unmeasured
from recon4.recording.samples.tuning import CARRIED_ON, REPEATED
from recon4.recording.samples.units import GyroUnit, in_degrees, in_m_s2, in_rad_s

Samples = TypeVar("Samples", ImuSamples, GnssSamples)


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
    imu: ImuSamples,
    *,
    offset_s: float,
    jumps_ns: Sequence[int],
    report: ImportReport,
    gyro_unit: GyroUnit = "auto",
) -> ImuSamples | None:
    """Sorted, unique and finite samples on the rig's clock; None when nothing is left.

    Args:
        imu: Samples in order of arrival.
        offset_s: Added to their times [s].
        jumps_ns: How far the LiDARs' clock, or that of the recorder, went back [ns]; negative =
            ahead. A jump of the IMU like one of these is the same jump, and is carried on by the
            same amount.
        report: Gets the counts ``imu_wrong_time``, ``imu_nan``, ``imu_duplicate``, ``imu_copies``,
            ``imu_unsorted``, ``imu_in_bursts``, ``imu_repeated``, those of `with_forces`, and what
            was not measured (`imu_channels`) or in which unit (`in_rad_s`, `in_m_s2`).
        gyro_unit: Of the angular rates.
    """
    imu = _without_strays(imu, "imu", report)
    channels = imu_channels(_carried_on(imu, jumps_ns, report))
    if channels.no_gyroscope:
        report.warn(
            FindingKind.GYROSCOPE_MISSING,
            forces=not channels.no_accelerometer,
            **channels.no_gyroscope.values,
        )
        return None
    turns, alone = _by_channel(channels.imu, report)
    imu = _sorted(turns, offset_s, "imu", report=report)
    imu = _without_stuck_forces(_without_repeated(imu, report))
    if channels.no_accelerometer:
        report.warn(FindingKind.ACCELEROMETER_MISSING, **channels.no_accelerometer.values)
    else:
        imu = with_forces(imu, _sorted(alone, offset_s, "imu", report=ImportReport()), report)
    report.count("imu_kept", len(imu))
    if not len(imu):
        report.warn(FindingKind.IMU_EMPTY)
        return None
    scaled = in_rad_s(imu, gyro_unit, report)
    return None if scaled is None else in_m_s2(scaled, report)


def clean_gnss(gnss: GnssSamples, *, offset_s: float, report: ImportReport) -> GnssSamples | None:
    """Sorted, unique and valid positions on the rig's clock; None when nothing is left."""
    gnss = _without_strays(gnss, "gnss", report)
    place = np.isfinite(gnss.lat_rad) & np.isfinite(gnss.lon_rad)
    place &= (np.abs(gnss.lat_rad) <= np.pi / 2) & (np.abs(gnss.lon_rad) <= 2 * np.pi)
    # Receivers without a fix write anything as their place: NaN, 0 or the last one.
    invalid = gnss.quality == GnssQuality.INVALID
    damaged = ~place & ~invalid
    report.count("gnss_nan", int(np.count_nonzero(damaged)))
    report.count("gnss_no_fix", int(np.count_nonzero(invalid)))
    usable = without_unmeasured(_take(gnss, place & ~invalid), report)
    usable = in_degrees(usable, report)
    found = _sorted(usable, offset_s, "gnss", report=report)
    report.count("gnss_kept", len(found))
    if len(found) and not np.isfinite(found.height_m).any():
        report.derive(DerivedKind.HEIGHTS_MISSING)
    if not len(found):
        report.warn(
            FindingKind.GNSS_EMPTY,
            fixes=len(gnss),
            no_fix=int(invalid.sum()),
            no_place=int(damaged.sum()),
            at_zero=int((~damaged & ~invalid).sum()),
        )
        return None
    return found


def _by_channel(imu: ImuSamples, report: ImportReport) -> tuple[ImuSamples, ImuSamples]:
    """The samples with angular rates, and those with accelerations alone; damaged ones are out.

    Samples may have one channel: gyroscope and accelerometer may be two topics, or the
    accelerometer may be slower or missing.
    """
    turns, forces = (np.isfinite(v).sum(axis=1) for v in (imu.gyro_rad_s, imu.accel_m_s2))
    apart = not np.any((turns == 3) & (forces == 3))
    damaged = ~np.isin(turns, (0, 3)) | ~np.isin(forces, (0, 3))
    damaged |= (turns == 0) & ((forces == 0) | (not apart))
    report.count("imu_nan", int(np.count_nonzero(damaged)))
    return _take(imu, ~damaged & (turns == 3)), _take(imu, ~damaged & (turns == 0))


def _build(record: Samples, column: Any) -> Samples:
    return type(record)(**{f.name: column(f.name) for f in fields(record)})


def _take(samples: Samples, rows: NDArray[Any]) -> Samples:
    return _build(samples, lambda name: getattr(samples, name)[rows])


def _without_strays(samples: Samples, kind: str, report: ImportReport) -> Samples:
    """The samples without single ones of another time."""
    apart = strays(samples.t_ns)
    report.count(f"{kind}_wrong_time", int(np.count_nonzero(apart)))
    return _take(samples, ~apart) if apart.any() else samples


def _sorted(samples: Samples, offset_s: float, kind: str, *, report: ImportReport) -> Samples:
    order = np.argsort(samples.t_ns, kind="stable")
    new = np.diff(samples.t_ns[order], prepend=np.iinfo(np.int64).min) != 0
    copies = ~new & _equal_to_last(samples, order)
    report.count(f"{kind}_copies", int(np.count_nonzero(copies)))
    samples = _going_on(_take(samples, np.sort(order[~copies])), kind, report)
    report.count(f"{kind}_unsorted", int(np.count_nonzero(np.diff(samples.t_ns) < 0)))
    samples = _take(samples, np.argsort(samples.t_ns, kind="stable"))
    found_ns = without_bursts(samples.t_ns, report) if kind == "imu" else samples.t_ns
    new = np.diff(found_ns, prepend=np.iinfo(np.int64).min) != 0
    report.count(f"{kind}_duplicate", int(np.count_nonzero(~new)))
    samples, shifted = _take(samples, new), found_ns[new] + round(offset_s * 1e9)
    return _build(samples, lambda n: shifted if n == "t_ns" else getattr(samples, n))


def _going_on(samples: Samples, kind: str, report: ImportReport) -> Samples:
    """Samples in order of arrival, on a clock that goes on where it was set back."""
    first = first_of_bursts(samples.t_ns)
    first = np.arange(len(samples)) if first is None else first
    found = going_on(samples.t_ns[first])
    if found is None:
        return samples
    say_set_back(kind.upper(), found.steps, report)
    t_ns = samples.t_ns + np.repeat(found.shift_ns, np.diff(np.append(first, len(samples))))
    return _build(samples, lambda name: t_ns if name == "t_ns" else getattr(samples, name))


def _equal_to_last(samples: Samples, order: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether each sample has the values of the one before it in order of time, (N,).

    A receiver that repeats its last solution loses nothing.
    """
    equal = np.ones(len(order), np.bool_)
    for field in fields(samples):
        values = np.asarray(getattr(samples, field.name))[order]
        same = np.isclose(values[1:], values[:-1], rtol=0.0, atol=0.0, equal_nan=True)
        equal[1:] &= same if same.ndim == 1 else same.all(axis=1)
    return equal


def _carried_on(imu: ImuSamples, jumps_ns: Sequence[int], report: ImportReport) -> ImuSamples:
    steps = np.diff(imu.t_ns)
    shift: Times = np.zeros(len(imu), np.int64)
    for row in np.flatnonzero(np.abs(steps) > CARRIED_ON.least_ns):
        step = int(steps[row])
        near_ns = CARRIED_ON.ahead_ns if step > 0 else CARRIED_ON.back_ns
        like = [j for j in jumps_ns if abs(j + step) < near_ns]
        if like:
            shift[row + 1 :] += like[0]
            report.count("imu_jumps_back" if step < 0 else "imu_jumps_ahead")
    return ImuSamples(imu.t_ns + shift, imu.gyro_rad_s, imu.accel_m_s2)


def _without_repeated(imu: ImuSamples, report: ImportReport) -> ImuSamples:
    """Drop what a driver that hangs repeats with new time stamps: a gap is honest."""
    values = np.concatenate([imu.gyro_rad_s, np.nan_to_num(imu.accel_m_s2)], axis=1)
    runs = _repeated_in_motion(values, imu, least=REPEATED.least_repeated)
    if not runs:
        return imu
    repeated = np.concatenate(runs)
    report.count("imu_repeated", len(repeated))
    longest_s = 1e-9 * max(int(imu.t_ns[run[-1]] - imu.t_ns[run[0] - 1]) for run in runs)
    first_s = 1e-9 * int(imu.t_ns[repeated[0]] - imu.t_ns[0])
    report.warn(
        FindingKind.IMU_REPEATED,
        sensor="IMU",
        times=len(runs),
        first_s=first_s,
        longest_s=longest_s,
        samples=len(repeated),
    )
    return _take(imu, np.delete(np.arange(len(imu)), repeated))


def _without_stuck_forces(imu: ImuSamples) -> ImuSamples:
    """Accelerations that stay the same while the gyroscope measures a motion become NaN."""
    runs = _repeated_in_motion(imu.accel_m_s2, imu, least=REPEATED.least_stuck)
    accel = imu.accel_m_s2.copy()
    for run in runs:
        accel[run] = np.nan
    return ImuSamples(imu.t_ns, imu.gyro_rad_s, accel)


def _repeated_in_motion(values: Array, imu: ImuSamples, *, least: int) -> list[NDArray[np.intp]]:
    """Rows that equal the one before while the body turns, in runs of at least a length."""
    same = np.all(values[1:] == values[:-1], axis=1)
    moving = np.linalg.norm(imu.gyro_rad_s[1:], axis=1) > REPEATED.moving_rad_s
    rows = np.flatnonzero(same & moving) + 1
    runs = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)
    return [run for run in runs if len(run) >= least]
