"""The table that normalizes intensities (V §2.10, Eq. 2.17; requirements A9, A0 no. 7)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False, kw_only=True)
class IntensityTable:
    """``x' = (x - mean_i) * target_std / std_i + target_mean`` with mean and deviation of a bin."""

    SHIFT_ONLY: ClassVar[float] = 0.01
    """Bins with a smaller deviation are shifted, not scaled."""
    mean: NDArray[np.float32]
    """Mean raw intensity by sensor, ring, incidence (last: no normal), range, (S, B, I, R)."""
    std: NDArray[np.float32]
    """Standard deviation of raw intensity, the divisor, (S, B, I, R)."""
    level: NDArray[np.uint8]
    """How many bins were merged: row of `recon4.intensity.table.COARSER`, (S, B, I, R); one past
    the last = all points. In a table learned from surfaces: 0 = the bin itself, 1 = mostly the
    factors, one past the last = a beam without points."""
    target_mean: float
    target_std: float
    upper: float
    """Upper limit of normalized intensities; the lower one is 0."""
    incidence_bin_rad: float
    range_bin_m: float

    @cached_property  # every tile of a map is normalized by both
    def gain(self) -> NDArray[np.float32]:
        """Factor of each bin; 1 if the deviation is too small as a divisor, (S, B, I, R)."""
        safe = np.where(self.std < self.SHIFT_ONLY, np.float32(self.target_std or 1.0), self.std)
        return np.asarray((self.target_std or 1.0) / safe, dtype=np.float32)

    @cached_property
    def offset(self) -> NDArray[np.float32]:
        """Added after the factor, (S, B, I, R)."""
        return np.asarray(self.target_mean - self.gain * self.mean, dtype=np.float32)
