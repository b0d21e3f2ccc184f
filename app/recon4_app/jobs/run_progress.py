"""Progress of a whole run: a fold over the events of its worker, like `recon4_app.jobs.status`.

A stage is weighted by its usual time (`recon4.store.stage.Stage.percent`), a piece of work within
it likewise.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from recon4.model.events import Event, RunStarted, StageChanged, WorkProgress
from recon4.workflows.lidar import LIDAR
from recon4_app.jobs.tuning import ESTIMATES

BEFORE, AFTER = "hash", "results"
"""Work outside of any stage: hashing the recording, copying the results."""

STAGE_PERCENT = {
    BEFORE: 2.0,
    **{stage.name: stage.percent for stage in LIDAR.stages if stage.percent},
    AFTER: 5.0,
}
"""Stage -> its usual part of the time [%]."""

PIECES = {
    ("graph", "view volumes"): (0.0, 0.2),
    ("graph", "pairs"): (0.2, 0.55),
    ("classes", "find the carrier"): (0.0, 0.1),
    ("classes", "classify points"): (0.1, 1.0),
    ("map", "place points"): (0.0, 0.4),
    ("map", "map"): (0.4, 0.6),
    ("map", "export"): (0.6, 0.97),
}
"""Where within its stage a piece of work begins and ends; others span the whole stage."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RunProgress:
    """Progress of a run."""

    stage: str = BEFORE
    """The current stage."""
    past: float = 0.0
    """Fraction of the run in the stages before it."""
    reused: float = 0.0
    """Fraction of the run in stages that were reused and took no time."""
    reached: float = 0.0
    """Fraction of the current stage that is done."""
    span: tuple[float, float] = (0.0, 1.0)
    """Where the current piece of work begins and ends within the stage."""
    began_s: float = 0.0
    now_s: float = 0.0
    over: bool = False

    @property
    def fraction(self) -> float:
        """Fraction of the whole run, 0 to 1."""
        return 1.0 if self.over else min(self.past + self.reached * stage_weight(self.stage), 1.0)

    @property
    def eta_s(self) -> float | None:
        """Remaining time of the whole run [s], None = not known yet."""
        worked, passed_s = self.fraction - self.reused, self.now_s - self.began_s
        if self.over or worked < ESTIMATES.known_after or passed_s < ESTIMATES.known_after_s:
            return None
        return passed_s * (1.0 - self.fraction) / worked


def stage_weight(stage: str) -> float:
    """Weight of a stage in the whole run; 0 for an unknown stage."""
    return STAGE_PERCENT.get(stage, 0.0) / sum(STAGE_PERCENT.values())


def after(progress: RunProgress, event: Event) -> RunProgress:
    """The progress after one more event."""
    t_s = progress.now_s if event.t is None else event.t
    progress = replace(progress, now_s=t_s)
    match event:
        case RunStarted():
            return RunProgress(began_s=t_s, now_s=t_s)
        case StageChanged(stage=stage, state="running"):
            return _next(progress, stage)
        case StageChanged(stage=stage, state=state):
            reused = progress.reused + (stage_weight(stage) if state == "reused" else 0.0)
            return replace(progress, reached=1.0, reused=reused)
        case WorkProgress(what=what, done=done, total=total):
            if what == AFTER and progress.stage != AFTER:
                progress = _next(progress, AFTER)
            return _piece(progress, what, done / total if total else 0.0)
    return progress


def _next(progress: RunProgress, stage: str) -> RunProgress:
    past = progress.past + stage_weight(progress.stage)
    return replace(progress, stage=stage, past=past, reached=0.0, span=(0.0, 1.0))


def _piece(progress: RunProgress, what: str, fraction: float) -> RunProgress:
    low, high = progress.span
    if fraction == 0.0:
        low, high = PIECES.get((progress.stage, what), (0.0, 0.98))
        if progress.reached > low:  # the same piece once more: half of what is left
            low, high = progress.reached, (progress.reached + 1.0) / 2.0
    reached = max(progress.reached, low + min(fraction, 1.0) * (high - low))
    return replace(progress, reached=min(reached, 1.0), span=(low, high))
