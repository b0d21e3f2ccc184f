"""The verdict on a map: good, check, or do not use, with its reasons.

It is worked out in one place, from the findings of the report, and stands in ``summary.json``, on
the terminal, in the report and on the pages.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from recon4.model.usability import Usability
from recon4.report.artifacts import read_results
from recon4.report.drift import closed_drift
from recon4.report.facts import ReportFacts
from recon4.report.findings import Finding, Level, find


@dataclass(frozen=True, slots=True)
class MapVerdict:
    """A usability and why it is not better."""

    usability: Usability
    reasons: tuple[str, ...]
    """The findings that led to it, worst first; empty for a good map."""


_USABILITY = {
    Level.GOOD: Usability.GOOD,
    Level.NOTE: Usability.GOOD,
    Level.WARNING: Usability.CHECK,
    Level.BAD: Usability.DO_NOT_USE,
}


def assess(facts: ReportFacts) -> MapVerdict:
    """The verdict on the map of a run, from its artifacts.

    Raises:
        StoreError: If an artifact is damaged.
    """
    results = read_results(facts.artifacts)
    return map_verdict(find(facts, results, closed_drift(results)))


def map_verdict(findings: Sequence[Finding]) -> MapVerdict:
    """The worst finding decides. Without any finding nothing was checked: not good."""
    if not findings:
        return MapVerdict(Usability.CHECK, ("Nothing of this map could be checked.",))
    worst = max(finding.level for finding in findings)
    reasons = [finding for finding in findings if finding.level >= Level.WARNING]
    ordered = sorted(reasons, key=lambda finding: -finding.level)
    return MapVerdict(_USABILITY[worst], tuple(finding.text for finding in ordered))
