"""Whether the trajectory is one that a person on foot can have walked."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.tuning import SPEED_WITNESS
from recon4.geometry.se3 import Array
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class TooFast:
    """Where the trajectory moves faster than a person."""

    seconds: int
    """How many seconds of the walk are faster than `SPEED_WITNESS.max_speed_m_s`."""
    fastest_m_s: float
    at_s: float
    """Time of the fastest second, after the start [s]."""


def too_fast(trajectory: Trajectory) -> TooFast | None:
    """The seconds in which the positions lie farther apart than a person walks; None = none."""
    if len(trajectory) < 2:
        return None
    t_s = (trajectory.t_ns - trajectory.t_ns[0]) / 1e9
    knots = np.arange(0.0, t_s[-1] + 1e-9, SPEED_WITNESS.window_s)
    if len(knots) < 2:
        return None
    p: Array = np.stack([np.interp(knots, t_s, trajectory.T_a_b.t[:, k]) for k in range(3)], 1)
    speed_m_s = np.linalg.norm(np.diff(p, axis=0), axis=1) / SPEED_WITNESS.window_s
    fast = speed_m_s > SPEED_WITNESS.max_speed_m_s
    if not fast.any():
        return None
    worst = int(np.argmax(speed_m_s))
    return TooFast(int(fast.sum()), float(speed_m_s[worst]), float(knots[worst]))


class Speed(Witness):
    """Jumps of the trajectory."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Whether a person can have walked it."""
        line = walk.final if walk.final is not None else walk.odometry
        fast = too_fast(line) if line is not None else None
        if fast is not None:
            yield finding(
                FindingKind.TOO_FAST,
                Level.DO_NOT_USE,
                {
                    "fastest_m_s": fast.fastest_m_s,
                    "at_s": fast.at_s,
                    "seconds": fast.seconds,
                    "limit_m_s": SPEED_WITNESS.max_speed_m_s,
                },
                span_s=(fast.at_s, fast.at_s + SPEED_WITNESS.window_s),
            )
