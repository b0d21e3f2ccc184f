"""How well the surfaces of a map hold each multiframe of line scans where it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times


@dataclass(frozen=True, slots=True, eq=False)
class SurfaceSupport:
    """What the last round of the refinement found around each multiframe. N multiframes."""

    t_mid_ns: Times
    """Middle of each [ns], (N,)."""
    match_ratio: Array
    """Part of its points on surfaces that were measured at other times, 0..1, (N,)."""
    weak_sd_m: Array
    """Standard deviation of the position along its weakest direction by these surfaces alone [m],
    (N,)."""
    weak_direction: NDArray[np.float64]
    """Unit vector of that direction in the map, (N, 3)."""
