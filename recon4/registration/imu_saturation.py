"""An IMU at the end of its range: it repeats one largest value while the body turns faster."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.samples import ImuSamples
from recon4.registration.tuning_imu import SATURATION


@dataclass(frozen=True, slots=True)
class SaturatedAxis:
    """An axis of an IMU that repeats its largest value."""

    sensor: str
    """``gyroscope`` or ``accelerometer``."""
    axis: str
    largest: float
    """[rad/s] or [m/s²]."""
    runs: list[NDArray[np.intp]]
    """Samples of each stretch."""


def saturated_axes(imu: ImuSamples) -> list[SaturatedAxis]:
    """The axes that are saturated at some time.

    A sample that is repeated until the next one is there counts once. A sensor that counts in
    coarse steps repeats the largest one at the peak of a motion, too, but the step below as well.
    One that counts in fine steps has other values at its peak, which are as near to the largest.

    Args:
        imu: As recorded, in its own axes.
    """
    both = np.hstack([imu.gyro_rad_s, imu.accel_m_s2])
    new = np.flatnonzero((both != np.roll(both, 1, axis=0)).any(axis=1))
    gyro = _saturated("gyroscope", imu.gyro_rad_s, new, least=SATURATION.slowest_rad_s)
    accel = _saturated("accelerometer", imu.accel_m_s2, new, least=SATURATION.weakest_m_s2)
    return gyro + accel


def saturated_samples(imu: ImuSamples) -> NDArray[np.bool_]:
    """Samples at which gyroscope and accelerometer are saturated along some axis, (N, 2)."""
    found = np.zeros((len(imu), 2), np.bool_)
    for axis in saturated_axes(imu):
        column = int(axis.sensor == "accelerometer")
        for run in axis.runs:
            found[run[0] : run[-1] + 1, column] = True
    return found


def _saturated(
    sensor: str, values: Array, new: NDArray[np.intp], *, least: float
) -> list[SaturatedAxis]:
    """The saturated axes of a sensor, (N, 3), by its new samples."""
    found = []
    for axis, column in zip("xyz", values.T, strict=True):
        runs = [new[run] for run in _runs_at_the_end(column[new], least)]
        if sum(map(len, runs)) >= SATURATION.least_samples:
            largest = float(np.nanmax(np.abs(column)))
            found.append(SaturatedAxis(sensor, axis, largest, runs))
    return found


def _runs_at_the_end(values: Array, least: float) -> list[NDArray[np.intp]]:
    """Rows of each run of the largest value, of either sign."""
    size = np.abs(np.nan_to_num(values))
    largest = float(size.max(initial=0.0))
    if largest < least:
        return []
    ends_at = (1.0 - SATURATION.same) * largest
    steps = np.diff(np.unique(size))
    step = max(float(steps.min(initial=largest)), largest - ends_at)
    rows = np.flatnonzero(size >= ends_at)
    below = np.count_nonzero((size >= largest - 1.5 * step) & (size < ends_at))
    repeats = len(np.unique(values[rows])) <= SATURATION.distinct * len(rows)
    if not repeats or len(rows) < SATURATION.piled_up * below:
        return []
    runs = np.split(rows, np.flatnonzero(np.diff(rows) > SATURATION.bridged) + 1)
    return [run for run in runs if len(run) >= SATURATION.least_run]
