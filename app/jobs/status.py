"""Status of a job: a fold over the events its worker wrote (`app.jobs.events`)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any


@dataclass(frozen=True, slots=True, kw_only=True)
class StageStatus:
    """One stage of the run."""

    stage: str
    state: str
    """``running``, ``done`` or ``reused`` (found finished)."""
    seconds: float | None = None
    """Duration [s], None while it runs."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Status:
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
    def where(self) -> str:
        """The current stage and piece of work as text."""
        if not self.what:
            return "before it began"
        running = [row.stage for row in self.stages if row.state == "running"]
        return f"in stage {running[-1]} ({self.what})" if running else f"in {self.what}"

    @property
    def fraction(self) -> float | None:
        """Fraction of the piece of work that is done, None = not known."""
        return min(self.done / self.total, 1.0) if self.total else None


def after(status: Status, event: dict[str, Any]) -> Status:
    """The status after one more event; unknown events change nothing."""
    match event:
        case {"kind": "run"}:
            return Status()
        case {"kind": "stage", "stage": str(stage), "state": str(state)}:
            fresh = StageStatus(stage=stage, state=state, seconds=event.get("seconds"))
            others = tuple(row for row in status.stages if row.stage != stage)
            return Status(stages=(*others, fresh))
        case {"kind": "progress", "what": what, "done": done, "total": total, "seconds": seconds}:
            rate = done / seconds if seconds > 0.0 else 0.0
            eta = (total - done) / rate if total and rate > 0.0 else None
            unit = str(event.get("unit", ""))
            counts = {"done": done, "total": total, "rate_per_s": rate, "eta_s": eta}
            return replace(status, what=what, unit=unit, **counts)
    return status
