"""Times of stamps that count from the full hour."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.units import HOUR_NS


def nearest_hour(t_us: NDArray[np.integer], near_ns: Times | int) -> Times:
    """Absolute times [ns] that are ``t_us`` past an hour and nearest to given times."""
    past_ns = np.asarray(t_us, dtype=np.int64) * 1000
    near = np.asarray(near_ns, dtype=np.int64)
    return past_ns + (near - past_ns + HOUR_NS // 2) // HOUR_NS * HOUR_NS
