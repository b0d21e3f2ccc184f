"""What decisions of people contradict, or no longer change, as findings."""

from __future__ import annotations

from recon4.findings.finding import Finding, Level
from recon4.findings.kinds import FindingKind
from recon4.model.figures import ReviewFigures


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
