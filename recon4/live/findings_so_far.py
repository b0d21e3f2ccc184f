"""What is known of the map while the walk goes on: problems that the newest messages forget."""

from __future__ import annotations

from recon4.findings.imu_axes import axes_findings
from recon4.findings.verdict import verdict_of
from recon4.findings.wording import text_of
from recon4.live.findings import CaptureFinding, capture_texts
from recon4.live.findings import Level as Urgency
from recon4.live.protocol import Pose
from recon4.live.stretches import Stretches
from recon4.live.tuning import SO_FAR
from recon4.locales.languages import ENGLISH
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.tuning import OBSERVATION
from recon4.model.usability import Usability


class WalkSoFar:
    """Counts over the poses of a walk what decides its verdict, by the limits of the audit.

    It never says that a map is good: that is worked out from the finished map.
    """

    def __init__(self) -> None:
        self.multiframes = self.lost = 0
        self.unobserved_s = 0.0
        """Time in stretches along which one direction is hardly observed [s]."""
        self.stretches = Stretches()
        """Where the walk had these problems."""
        self._stretch_s = 0.0
        self._t_ns: int | None = None
        self._of_imu: list[Finding] = []
        """What is wrong with the axes of the IMU."""

    def take(self, pose: Pose) -> None:
        """Count a pose; one that is not newer than the last was counted before."""
        if self._t_ns is not None and pose.t_ns <= self._t_ns:
            return
        step_s = 0.0 if self._t_ns is None else (pose.t_ns - self._t_ns) / 1e9
        self._t_ns = pose.t_ns
        self.multiframes += 1
        self.lost += pose.lost
        self._of_imu = list(axes_findings(pose.imu_turn, pose.imu_axes)) or self._of_imu
        weak = (
            not pose.lost and pose.weak_sd_m is not None and pose.weak_sd_m > OBSERVATION.weak_sd_m
        )
        follows = 0.0 < step_s <= SO_FAR.longest_step_s
        if not follows:
            self.stretches.take(None, pose.p, counts=False)
        if follows and weak:
            before_s = self._counted_s
            self._stretch_s += step_s
            self.unobserved_s += self._counted_s - before_s
        else:
            self._stretch_s = 0.0
        self._mark(pose, weak=follows and weak)

    def _mark(self, pose: Pose, *, weak: bool) -> None:
        if pose.lost:
            self.stretches.take("TRACKING-LOST", pose.p, counts=True)
        elif weak:
            self.stretches.take("WEAK-DIRECTION", pose.p, counts=self._counted_s > 0.0)
        else:
            self.stretches.take(None, pose.p, counts=False)

    @property
    def _counted_s(self) -> float:
        """Of the present stretch: short ones are bridged by the motion before them."""
        return self._stretch_s if self._stretch_s >= OBSERVATION.weak_s else 0.0

    def problems(self) -> list[Finding]:
        """Findings about the walk so far."""
        found = list(self._of_imu)
        if self.lost:
            values: dict[str, Value] = {
                "lost": self.lost,
                "multiframes": self.multiframes,
                "ratio": self.lost / self.multiframes,
                "so_far": True,
            }
            found.append(
                Finding(kind=FindingKind.TRACKING_LOST, level=Level.DO_NOT_USE, values=values)
            )
        if self.unobserved_s:
            bad = self.unobserved_s >= OBSERVATION.unobserved_s
            found.append(
                Finding(
                    kind=FindingKind.WEAK_DIRECTION,
                    level=Level.DO_NOT_USE if bad else Level.CHECK,
                    values={"seconds": self.unobserved_s, "so_far": True},
                )
            )
        return found

    def findings(self, *, records: bool, language: str = ENGLISH) -> list[CaptureFinding]:
        """One line with the verdict so far; none if nothing is known to be wrong.

        Args:
            records: Whether the walk goes on; what the operator can still change is more urgent.
            language: Of the texts.
        """
        found = self.problems()
        if not found:
            return []
        usability = verdict_of(found).usability
        urgent = usability is Usability.DO_NOT_USE and not records
        level: Urgency = "error" if urgent else "warning"
        said = " ".join(text_of(one, language) for one in found)
        bad = usability is Usability.DO_NOT_USE
        text = capture_texts(language)("so-far-do-not-use" if bad else "so-far-check", text=said)
        return [CaptureFinding(level, text)]
