"""Intensity normalization during a capture: a running table by sensor, ring and range."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.live.mapper.tuning import LIVE_INTENSITY


class LiveIntensity:
    """Running mean and deviation per bin; the stage ``intensity`` makes the final table."""

    def __init__(self, sensors: int) -> None:
        shape = (sensors, 128, LIVE_INTENSITY.ranges)
        self._count = np.zeros(shape)
        self._mean = np.zeros(shape)
        self._square = np.zeros(shape)

    def normalize(
        self,
        intensity: NDArray[Any],
        sensor: NDArray[Any],
        ring: NDArray[Any],
        *,
        range_m: Array,
    ) -> NDArray[np.uint8]:
        """Update the table with points and normalize them to mean 128 and deviation 48 per bin.

        Args:
            intensity: As measured, (N,).
            sensor: Row of the sensor, (N,).
            ring: Ring, (N,).
            range_m: Range [m], (N,).
        """
        bins = np.minimum(range_m / LIVE_INTENSITY.range_bin_m, LIVE_INTENSITY.ranges - 1).astype(
            np.intp
        )
        at = np.ravel_multi_index((sensor, np.minimum(ring, 127), bins), self._count.shape)
        value = intensity.astype(np.float64)
        fresh = np.bincount(at, minlength=self._count.size).reshape(self._count.shape)
        for table, weight in ((self._mean, value), (self._square, value**2)):
            total = np.bincount(at, weight, self._count.size).reshape(self._count.shape)
            table += (total - fresh * table) / np.maximum(self._count + fresh, 1.0)
        self._count = np.minimum(self._count + fresh, LIVE_INTENSITY.memory)
        mean = self._mean.ravel()[at]
        sd = np.sqrt(np.maximum(self._square.ravel()[at] - mean**2, 1.0))
        return np.clip(128.0 + 48.0 * (value - mean) / sd, 0.0, 255.0).astype(np.uint8)
