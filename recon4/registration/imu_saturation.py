"""An IMU at the end of its range: it repeats one largest value while the body turns faster."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.samples import ImuSamples

_SAME = 1e-4
"""Values that differ by less than this ratio are the same."""
_LEAST_RUN, _LEAST_SAMPLES = 3, 5
"""A peak of a motion has one largest sample, a saturated sensor repeats it."""
_BRIDGED = 20
"""At the ends of a stretch noise leaves the largest value for some samples."""
_SLOWEST_RAD_S, _WEAKEST_M_S2 = 1.5, 14.0
"""No range of an IMU ends below this."""


def saturated_texts(imu: ImuSamples) -> tuple[str, ...]:
    """A sentence for each sensor that is saturated.

    Args:
        imu: As recorded, in its own axes.
    """
    gyro, accel = _saturated(imu)
    texts = []
    if gyro:
        parts = [f"{np.rad2deg(s.largest):.0f}°/s about {s.axis} {s.times}" for s in gyro]
        texts.append(_text(imu, "gyroscope", parts, found=gyro))
    if accel:
        parts = [f"{s.largest:.1f} m/s² along {s.axis} {s.times}" for s in accel]
        texts.append(_text(imu, "accelerometer", parts, found=accel))
    return tuple(texts)


def saturated_samples(imu: ImuSamples) -> NDArray[np.bool_]:
    """Samples at which gyroscope and accelerometer are saturated along some axis, (N, 2)."""
    found = np.zeros((len(imu), 2), np.bool_)
    gyro, accel = _saturated(imu)
    for column, axes in enumerate((gyro, accel)):
        for run in (run for axis in axes for run in axis.runs):
            found[run[0] : run[-1] + 1, column] = True
    return found


@dataclass(frozen=True, slots=True)
class _Saturated:
    """An axis that repeats its largest value."""

    axis: str
    largest: float
    runs: list[NDArray[np.intp]]
    """Samples of each stretch."""

    @property
    def times(self) -> str:
        return "once" if len(self.runs) == 1 else f"{len(self.runs)} times"


def _text(imu: ImuSamples, name: str, parts: list[str], *, found: list[_Saturated]) -> str:
    first_ns = int(imu.t_ns[min(axis.runs[0][0] for axis in found)] - imu.t_ns[0])
    return (
        f"The {name} is saturated, first {1e-9 * first_ns:.1f} s after its start: it repeats its "
        f"largest value, {', '.join(parts)}. Faster motions are missing: there only the "
        "LiDARs observe them. Record with a larger range."
    )


def _saturated(imu: ImuSamples) -> tuple[list[_Saturated], list[_Saturated]]:
    """The saturated axes of gyroscope and accelerometer."""
    return (
        _saturated_axes(imu.gyro_rad_s, _SLOWEST_RAD_S),
        _saturated_axes(imu.accel_m_s2, _WEAKEST_M_S2),
    )


def _saturated_axes(values: Array, least: float) -> list[_Saturated]:
    """The saturated axes of a sensor, (N, 3)."""
    found = []
    for axis, column in zip("xyz", values.T, strict=True):
        runs = _runs_at_the_end(column, least)
        if sum(map(len, runs)) >= _LEAST_SAMPLES:
            largest = float(np.nanmax(np.abs(column)))
            found.append(_Saturated(axis, largest, runs))
    return found


def _runs_at_the_end(values: Array, least: float) -> list[NDArray[np.intp]]:
    """Rows of each run of the largest value, of either sign."""
    size = np.abs(np.nan_to_num(values))
    largest = float(size.max(initial=0.0))
    if largest < least:
        return []
    rows = np.flatnonzero(size >= (1.0 - _SAME) * largest)
    runs = np.split(rows, np.flatnonzero(np.diff(rows) > _BRIDGED) + 1)
    return [run for run in runs if len(run) >= _LEAST_RUN]
