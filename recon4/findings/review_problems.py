"""What decisions of people contradict, or no longer change, as findings."""

from __future__ import annotations

from recon4.model.figures import ReviewFigures
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind


def problem_findings(figures: ReviewFigures) -> list[Finding]:
    """Findings about the decisions of a review; none if all of them fit."""
    problems = (
        (FindingKind.REVIEW_CONFLICT, figures.conflicts, figures.conflict_pairs),
        (FindingKind.REVIEW_WITHOUT_EFFECT, figures.missing, figures.missing_pairs),
        (FindingKind.REVIEW_OUTDATED, figures.changed, figures.changed_pairs),
    )
    return [
        Finding(kind=kind, level=Level.CHECK, values={"count": count, "pairs": ", ".join(pairs)})
        for kind, count, pairs in problems
        if count
    ]
