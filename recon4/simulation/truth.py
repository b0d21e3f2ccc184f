"""The exact answer to a simulated recording."""

from __future__ import annotations

import numpy as np

from recon4.model.trajectory import Trajectory
from recon4.simulation.walk import Walk

TRUTH_RATE_HZ = 200


def true_trajectory(walk: Walk, *, epoch_ns: int) -> Trajectory:
    """``T_map_body`` at 200 Hz over the whole walk."""
    period_ns = 1_000_000_000 // TRUTH_RATE_HZ
    t_ns = np.arange(int(walk.seconds * TRUTH_RATE_HZ) + 1, dtype=np.int64) * period_ns
    return Trajectory(epoch_ns + t_ns, walk.poses(1e-9 * t_ns))
