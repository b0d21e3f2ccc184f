"""What a ground truth says of a map, as findings."""

from __future__ import annotations

from collections.abc import Iterator

from recon4.evaluation.evaluate import Evaluation
from recon4.findings.finding import Finding, Level, Value
from recon4.findings.kinds import FindingKind

_GOAL_M = 0.05
"""Required relative error, V §3 [m]."""
_COVERED = 0.95


def accuracy_findings(found: Evaluation | None) -> Iterator[Finding]:
    """Errors against the goal, and what the ground truth does not cover; None = there is none."""
    if found is None:
        return
    if found.relative is not None:
        error_m = found.relative.point_weighted.mean_m
        within = error_m <= _GOAL_M
        yield Finding(
            kind=FindingKind.ERROR_RELATIVE,
            level=Level.GOOD if within else Level.DO_NOT_USE,
            values={
                "error_m": error_m,
                "goal_m": _GOAL_M,
                "side": "within" if within else "above",
            },
        )
    rmse_m = found.aligned.position_m.rmse
    yield Finding(
        kind=FindingKind.ERROR_TRAJECTORY,
        level=Level.GOOD if rmse_m <= _GOAL_M else Level.NOTE,
        values={"error_m": rmse_m},
    )
    if found.coverage_ratio < _COVERED:
        values: dict[str, Value] = {"ratio": found.coverage_ratio}
        yield Finding(kind=FindingKind.TRUTH_INCOMPLETE, level=Level.CHECK, values=values)
