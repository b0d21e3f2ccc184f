"""Which channels of the samples were measured.

Drivers fill what their sensor lacks with zeros, with a constant, with NaN, or declare it by a
covariance of -1. All of that is "not measured" here, in one place, and becomes NaN.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.recording.report import ImportReport
from recon4.recording.samples.tuning import MEASURED

Rows = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Unmeasured:
    """Why a sensor has not measured a channel."""

    why: Literal["absent", "zero", "constant"]
    axes: str = ""
    """Whose values never change."""
    samples: int = 0
    """In which they do not."""

    @property
    def values(self) -> dict[str, Value]:
        """As values of a finding."""
        constant: dict[str, Value] = {"axes": self.axes, "samples": self.samples}
        return {"why": self.why} | (constant if self.axes else {})

    @property
    def text(self) -> str:
        """In words."""
        match self.why:
            case "absent":
                return "it has no values, or is declared as not measured"
            case "zero":
                return "all its values are 0"
        return f"its values along {self.axes} never change in {self.samples} samples"


@dataclass(frozen=True, slots=True)
class ImuChannels:
    """The samples of an IMU, and what of it was not measured."""

    imu: ImuSamples
    """All-NaN rows where a channel was not measured."""
    no_gyroscope: Unmeasured | None
    """Why there are no angular rates; None = there are."""
    no_accelerometer: Unmeasured | None
    """Why there are no accelerations; None = there are."""


def declared_absent(covariance: Any) -> bool:
    """Whether a message declares that it has no such quantity (``sensor_msgs/Imu``).

    Args:
        covariance: Of the quantity, (9,), row by row; its first element is -1 then.
    """
    return len(covariance) > 0 and float(covariance[0]) == -1.0


def imu_channels(imu: ImuSamples, *, least: int = MEASURED.least_samples) -> ImuChannels:
    """Find the channels of an IMU that were not measured.

    Args:
        imu: In any order; a row may have one channel only, as of two topics.
        least: Samples from which on a value that never changes was not measured.
    """
    gyro, no_gyroscope = _measured(imu.gyro_rad_s, least)
    accel, no_accelerometer = _measured(_without_free_fall(imu.accel_m_s2), least)
    if no_accelerometer and _is_zero(imu.accel_m_s2):
        no_accelerometer = Unmeasured("zero")
    return ImuChannels(ImuSamples(imu.t_ns, gyro, accel), no_gyroscope, no_accelerometer)


def feels_gravity(accel: Array) -> Rows:
    """Rows (N, 3) that an accelerometer can have measured: whole, and not 0 along every axis."""
    return np.isfinite(accel).all(axis=1) & np.any(accel != 0.0, axis=1)


def without_unmeasured(fixes: GnssSamples, report: ImportReport) -> GnssSamples:
    """Fixes whose heights, standard deviations and attitudes are NaN where nobody measured them.

    Fixes at latitude 0, longitude 0 and those of a position that never changes are left out:
    counts ``gnss_at_zero`` and ``gnss_constant``.
    """
    at_zero = np.hypot(fixes.lat_rad, fixes.lon_rad) < MEASURED.at_zero_rad
    report.count("gnss_at_zero", int(np.count_nonzero(at_zero)))
    fixes = fixes.take(~at_zero)
    if len(fixes) >= MEASURED.least_fixes and _never_change(fixes.lat_rad, fixes.lon_rad):
        report.count("gnss_constant", len(fixes))
        report.warn(FindingKind.GNSS_CONSTANT, fixes=len(fixes))
        return fixes.take(slice(0))
    heights, attitudes = fixes.height_m, fixes.rpy_ned_rad
    if len(fixes) >= MEASURED.least_fixes and np.all(heights == 0.0):
        report.warn(FindingKind.GNSS_HEIGHTS_ZERO)
        heights = np.full_like(heights, np.nan)
    if len(fixes) >= MEASURED.least_fixes and _never_change(*attitudes.T):
        report.warn(FindingKind.INS_CONSTANT)
        attitudes = np.full_like(attitudes, np.nan)
    sd = np.where(fixes.sd_enu_m > 0.0, fixes.sd_enu_m, np.nan)
    return replace(fixes, height_m=heights, sd_enu_m=sd, rpy_ned_rad=attitudes)


def with_forces(imu: ImuSamples, alone: ImuSamples, report: ImportReport) -> ImuSamples:
    """Give each sample of the gyroscope an acceleration, if there are enough of them.

    An accelerometer may be slower, a topic of its own, or fail for a while. Over short holes its
    values are interpolated; samples in longer ones are left out, as a gap of the IMU. Counts
    ``imu_accel_interpolated`` and ``imu_accel_missing``.

    Args:
        imu: Samples of the gyroscope in order of time.
        alone: Samples of an accelerometer of its own in order of time, at any times; empty = the
            accelerations are among the samples.
        report: Receives what was done.
    """
    lacking: Rows = np.isnan(imu.accel_m_s2).sum(axis=1) > 0
    forces = alone if len(alone) else ImuSamples(*(v[~lacking] for v in _columns(imu)))
    if not len(forces) or not lacking.any():
        return imu
    accel, near = _interpolated(forces, imu.t_ns)
    if near[lacking].sum() + (~lacking).sum() < MEASURED.least_forces * len(imu):
        report.warn(
            FindingKind.ACCELEROMETER_SPARSE, samples=len(forces), gyroscope_samples=len(imu)
        )
        return ImuSamples(imu.t_ns, imu.gyro_rad_s, np.full_like(accel, np.nan))
    missing = lacking & ~near
    report.count("imu_accel_interpolated", int(np.count_nonzero(lacking & near)))
    report.count("imu_accel_missing", int(np.count_nonzero(missing)))
    if missing.any():
        report.warn(
            FindingKind.ACCELERATIONS_MISSING,
            missing=int(np.count_nonzero(missing)),
            samples=len(imu),
            first_s=1e-9 * int(imu.t_ns[missing][0] - imu.t_ns[0]),
        )
    accel = np.where(lacking[:, None], accel, imu.accel_m_s2)
    return ImuSamples(*(v[~missing] for v in _columns(replace(imu, accel_m_s2=accel))))


def _columns(imu: ImuSamples) -> tuple[NDArray[Any], ...]:
    return imu.t_ns, imu.gyro_rad_s, imu.accel_m_s2


def _interpolated(forces: ImuSamples, t_ns: NDArray[np.int64]) -> tuple[Array, Rows]:
    """Accelerations at other times, and whether measured ones are near on both sides."""
    after = np.searchsorted(forces.t_ns, t_ns).clip(0, len(forces) - 1)
    before = np.searchsorted(forces.t_ns, t_ns, side="right").clip(1) - 1
    hole_ns = MEASURED.longest_hole_ns
    # Beyond an end both neighbors are the same sample.
    far_ns = np.maximum(np.abs(forces.t_ns[after] - t_ns), np.abs(t_ns - forces.t_ns[before]))
    near = (far_ns <= hole_ns) & (forces.t_ns[after] - forces.t_ns[before] <= hole_ns)
    since, known = (v - forces.t_ns[0] for v in (t_ns, forces.t_ns))
    axes = [np.interp(since, known, axis) for axis in forces.accel_m_s2.T]
    return np.stack(axes, axis=1), near


def _measured(values: Array, least: int) -> tuple[Array, Unmeasured | None]:
    """The values, all NaN if they were not measured, and why."""
    nothing = np.full_like(values, np.nan)
    finite = values[np.isfinite(values).all(axis=1)]
    if not len(finite):
        return nothing, Unmeasured("absent")
    constant = [axis for axis, column in zip("xyz", finite.T, strict=True) if not np.ptp(column)]
    if len(finite) < least or not constant:
        return values, None
    if _is_zero(finite):
        return nothing, Unmeasured("zero")
    return nothing, Unmeasured("constant", ", ".join(constant), len(finite))


def _without_free_fall(accel: Array) -> Array:
    """Rows of exactly 0 become NaN: an accelerometer feels gravity, and its noise is never 0."""
    return np.where(np.all(accel == 0.0, axis=1)[:, None], np.nan, accel)


def _is_zero(values: Array) -> bool:
    return bool(len(values)) and not np.nan_to_num(values).any() and bool(np.any(values == 0.0))


def _never_change(*columns: Array) -> bool:
    """Whether columns have values, each of them one value only."""
    return all(np.isfinite(c).all() and not np.ptp(c) for c in columns)
