"""What a ground truth says of a map, as findings."""

from __future__ import annotations

from collections.abc import Iterator

from recon4.evaluation.evaluate import Evaluation
from recon4.findings.tuning import ACCURACY
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind


def accuracy_findings(found: Evaluation | None) -> Iterator[Finding]:
    """Errors against the goal, and what the ground truth does not cover; None = there is none."""
    if found is None:
        return
    if found.relative is not None:
        error_m = found.relative.point_weighted.mean_m
        within = error_m <= ACCURACY.goal_m
        yield Finding(
            kind=FindingKind.ERROR_RELATIVE,
            level=Level.GOOD if within else Level.DO_NOT_USE,
            values={
                "error_m": error_m,
                "goal_m": ACCURACY.goal_m,
                "side": "within" if within else "above",
            },
        )
    rmse_m = found.aligned.position_m.rmse
    yield Finding(
        kind=FindingKind.ERROR_TRAJECTORY,
        level=Level.GOOD if rmse_m <= ACCURACY.goal_m else Level.NOTE,
        values={"error_m": rmse_m},
    )
    if found.coverage_ratio < ACCURACY.covered:
        values: dict[str, Value] = {"ratio": found.coverage_ratio}
        yield Finding(kind=FindingKind.TRUTH_INCOMPLETE, level=Level.CHECK, values=values)
