"""What is known of the map while the walk goes on: problems that the newest messages forget."""

from __future__ import annotations

from recon4.live.findings import CaptureFinding, Level
from recon4.live.protocol import Pose
from recon4.model.usability import UNOBSERVED_SECONDS, WEAK_SD_M, WEAK_SECONDS, Usability

_LONGEST_STEP_S = 1.0
"""A longer time between two poses is an interruption, not an observation [s]."""


class WalkSoFar:
    """Counts over the poses of a walk what decides its verdict, by the limits of the report.

    It never says that a map is good: that is worked out from the finished map.
    """

    def __init__(self) -> None:
        self.multiframes = self.lost = 0
        self.unobserved_s = 0.0
        """Time in stretches along which one direction is hardly observed [s]."""
        self._stretch_s = 0.0
        self._t_ns: int | None = None

    def take(self, pose: Pose) -> None:
        """Count a pose; one that is not newer than the last was counted before."""
        if self._t_ns is not None and pose.t_ns <= self._t_ns:
            return
        step_s = 0.0 if self._t_ns is None else (pose.t_ns - self._t_ns) / 1e9
        self._t_ns = pose.t_ns
        self.multiframes += 1
        self.lost += pose.lost
        weak = not pose.lost and pose.weak_sd_m is not None and pose.weak_sd_m > WEAK_SD_M
        follows = 0.0 < step_s <= _LONGEST_STEP_S
        if not follows or not weak:
            self._stretch_s = 0.0
            return
        before_s = self._counted_s
        self._stretch_s += step_s
        self.unobserved_s += self._counted_s - before_s

    @property
    def _counted_s(self) -> float:
        """Of the present stretch: short ones are bridged by the motion before them."""
        return self._stretch_s if self._stretch_s >= WEAK_SECONDS else 0.0

    def findings(self, *, records: bool) -> list[CaptureFinding]:
        """One line with the verdict so far; none if nothing is known to be wrong.

        Args:
            records: Whether the walk goes on; what the operator can still change is more urgent.
        """
        reasons = []
        if self.lost:
            reasons.append(f"tracking was lost in {self.lost} of {self.multiframes} multiframes")
        if self.unobserved_s:
            text = f"one direction was hardly observed for {self.unobserved_s:.0f} s"
            reasons.append(text)
        if not reasons:
            return []
        bad = bool(self.lost) or self.unobserved_s >= UNOBSERVED_SECONDS
        usability = Usability.DO_NOT_USE if bad else Usability.CHECK
        level: Level = "error" if bad and not records else "warning"
        return [CaptureFinding(level, f"Map so far: {usability}; {', '.join(reasons)}")]
