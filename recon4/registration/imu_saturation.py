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

    Args:
        imu: As recorded, in its own axes.
    """
    gyro = _saturated("gyroscope", imu.gyro_rad_s, SATURATION.slowest_rad_s)
    return gyro + _saturated("accelerometer", imu.accel_m_s2, SATURATION.weakest_m_s2)


def saturated_samples(imu: ImuSamples) -> NDArray[np.bool_]:
    """Samples at which gyroscope and accelerometer are saturated along some axis, (N, 2)."""
    found = np.zeros((len(imu), 2), np.bool_)
    for axis in saturated_axes(imu):
        column = int(axis.sensor == "accelerometer")
        for run in axis.runs:
            found[run[0] : run[-1] + 1, column] = True
    return found


def _saturated(sensor: str, values: Array, least: float) -> list[SaturatedAxis]:
    """The saturated axes of a sensor, (N, 3)."""
    found = []
    for axis, column in zip("xyz", values.T, strict=True):
        runs = _runs_at_the_end(column, least)
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
    rows = np.flatnonzero(size >= (1.0 - SATURATION.same) * largest)
    runs = np.split(rows, np.flatnonzero(np.diff(rows) > SATURATION.bridged) + 1)
    return [run for run in runs if len(run) >= SATURATION.least_run]
