"""The exact answer, written beside a simulated recording."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.model.trajectory import Trajectory
from recon4.simulation.walk import Walk

TRUTH_RATE_HZ = 200


def true_trajectory(walk: Walk, *, epoch_ns: int) -> Trajectory:
    """``T_map_body`` at 200 Hz over the whole walk."""
    period_ns = 1_000_000_000 // TRUTH_RATE_HZ
    t_ns = np.arange(int(walk.seconds * TRUTH_RATE_HZ) + 1, dtype=np.int64) * period_ns
    return Trajectory(epoch_ns + t_ns, walk.poses(1e-9 * t_ns))


def write_tum(path: Path, trajectory: Trajectory) -> None:
    """Write ``seconds x y z qx qy qz qw`` a line; the seconds keep their nanoseconds."""
    T = trajectory.T_a_b
    with path.open("w", encoding="ascii") as file:
        for t_ns, t, q in zip(trajectory.t_ns, T.t, T.quat_xyzw(), strict=True):
            numbers = " ".join(f"{value:.9f}" for value in (*t, *q))
            file.write(f"{_seconds(int(t_ns))} {numbers}\n")


def _seconds(t_ns: int) -> str:
    return f"{t_ns // 1_000_000_000}.{t_ns % 1_000_000_000:09d}"
