"""Status of a job: a fold over the events its worker wrote (`recon4_app.jobs.events`)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from recon4.model.events import Event, RunStarted, StageChanged, WorkProgress


@dataclass(frozen=True, slots=True, kw_only=True)
class StageStatus:
    """One stage of the run."""

    stage: str
    state: str
    """``running``, ``done`` or ``reused`` (found finished)."""
    seconds: float | None = None
    """Duration [s], None while it runs."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JobStatus:
    """Current piece of work and stages of a running job."""

    what: str = ""
    """The current piece of work."""
    unit: str = ""
    done: int = 0
    total: int = 0
    """Units in all; 0 = not known."""
    rate_per_s: float = 0.0
    """Units finished per second since the piece began."""
    eta_s: float | None = None
    """Time left for this piece [s], None = not known."""
    stages: tuple[StageStatus, ...] = ()
    """Stages begun so far, in order."""

    @property
    def stage(self) -> str:
        """The current stage; empty = none."""
        running = [row.stage for row in self.stages if row.state == "running"]
        return running[-1] if running else ""

    @property
    def fraction(self) -> float | None:
        """Fraction of the piece of work that is done, None = not known."""
        return min(self.done / self.total, 1.0) if self.total else None


def after(status: JobStatus, event: Event) -> JobStatus:
    """The status after one more event; other events change nothing."""
    match event:
        case RunStarted():
            return JobStatus()
        case StageChanged():
            row = StageStatus(stage=event.stage, state=event.state, seconds=event.seconds)
            others = tuple(other for other in status.stages if other.stage != event.stage)
            return JobStatus(stages=(*others, row))
        case WorkProgress():
            rate = event.done / event.seconds if event.seconds > 0.0 else 0.0
            return replace(
                status,
                what=event.what,
                unit=event.unit,
                done=event.done,
                total=event.total,
                rate_per_s=rate,
                eta_s=(event.total - event.done) / rate if event.total and rate > 0.0 else None,
            )
    return status
