"""How far a whole run is: a fold over the events of its worker, like `app.jobs.status`.

A stage counts as long as it usually takes (shares of the time of a simulated walk of five minutes
on two processors), a piece of work within it likewise.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

BEFORE, AFTER = "hash", "results"
"""Work outside of any stage: hashing the recording, copying the results."""

SHARES = {
    BEFORE: 2.0,
    "frames": 9.0,
    "odometry": 14.0,
    "graph": 28.0,
    "verification": 2.0,
    "refine": 8.0,
    "level": 1.0,
    "intensity": 4.0,
    "map": 26.0,
    AFTER: 6.0,
}
"""Stage -> its usual share of the time [%]."""

PIECES = {
    ("graph", "view volumes"): (0.0, 0.2),
    ("graph", "pairs"): (0.2, 0.55),
    ("map", "place points"): (0.0, 0.4),
    ("map", "map"): (0.4, 0.6),
    ("map", "export"): (0.6, 0.97),
}
"""Where within its stage a piece of work begins and ends; others span the whole stage."""

KNOWN_AFTER_S, KNOWN_AFTER = 2.0, 0.02
"""The time left is told once so much time has passed and so much of the run is done."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RunProgress:
    """How far a run is."""

    stage: str = BEFORE
    """The stage in hand."""
    past: float = 0.0
    """Share of the stages behind it."""
    reused: float = 0.0
    """Share of those that were found finished and took no time."""
    reached: float = 0.0
    """Share of the stage in hand."""
    span: tuple[float, float] = (0.0, 1.0)
    """What the piece of work in hand covers of the stage."""
    began_s: float = 0.0
    now_s: float = 0.0
    over: bool = False

    @property
    def fraction(self) -> float:
        """Share of the whole run, 0 to 1."""
        return 1.0 if self.over else min(self.past + self.reached * stage_weight(self.stage), 1.0)

    @property
    def eta_s(self) -> float | None:
        """Time the whole run still takes [s], None = not known yet."""
        worked, passed_s = self.fraction - self.reused, self.now_s - self.began_s
        if self.over or worked < KNOWN_AFTER or passed_s < KNOWN_AFTER_S:
            return None
        return passed_s * (1.0 - self.fraction) / worked


def stage_weight(stage: str) -> float:
    """Share of a stage in the whole run; one nobody named takes none."""
    return SHARES.get(stage, 0.0) / sum(SHARES.values())


def after(overall: RunProgress, event: dict[str, Any]) -> RunProgress:
    """How far the run is after one more event."""
    t_s = float(event.get("t", overall.now_s))
    overall = replace(overall, now_s=t_s)
    match event:
        case {"kind": "run"}:
            return RunProgress(began_s=t_s, now_s=t_s)
        case {"kind": "stage", "stage": str(stage), "state": "running"}:
            return _next(overall, stage)
        case {"kind": "stage", "stage": str(stage), "state": str(state)}:
            reused = overall.reused + (stage_weight(stage) if state == "reused" else 0.0)
            return replace(overall, reached=1.0, reused=reused)
        case {"kind": "progress", "what": str(what), "done": done, "total": total}:
            if what == AFTER and overall.stage != AFTER:
                overall = _next(overall, AFTER)
            return _piece(overall, what, done / total if total else 0.0)
    return overall


def _next(overall: RunProgress, stage: str) -> RunProgress:
    past = overall.past + stage_weight(overall.stage)
    return replace(overall, stage=stage, past=past, reached=0.0, span=(0.0, 1.0))


def _piece(overall: RunProgress, what: str, fraction: float) -> RunProgress:
    low, high = overall.span
    if fraction == 0.0:
        low, high = PIECES.get((overall.stage, what), (0.0, 0.98))
        if overall.reached > low:  # the same piece once more: half of what is left
            low, high = overall.reached, (overall.reached + 1.0) / 2.0
    reached = max(overall.reached, low + min(fraction, 1.0) * (high - low))
    return replace(overall, reached=min(reached, 1.0), span=(low, high))
