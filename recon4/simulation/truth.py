"""The exact answer to a simulated recording."""

from __future__ import annotations

import numpy as np

from recon4.model.trajectory import Trajectory
from recon4.simulation.walk import Walk
from recon4.units import SECOND_NS


def true_trajectory(walk: Walk, *, epoch_ns: int, rate_hz: int = 200) -> Trajectory:
    """``T_map_body`` at a rate over the whole walk."""
    period_ns = SECOND_NS // rate_hz
    t_ns = np.arange(int(walk.seconds * rate_hz) + 1, dtype=np.int64) * period_ns
    return Trajectory(epoch_ns + t_ns, walk.poses(1e-9 * t_ns))
