"""Findings as the reports show them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from recon4.findings.wording import title_of, whole_text
from recon4.model.finding import Finding, Level
from recon4.model.usability import Usability
from recon4.report.tuning import FINDING_LISTS

LEVELS = {Usability.GOOD: "good", Usability.CHECK: "warning", Usability.DO_NOT_USE: "bad"}
"""Style of the headline."""
LEVEL_STYLES = {
    Level.GOOD: "good",
    Level.NOTE: "note",
    Level.CHECK: "warning",
    Level.DO_NOT_USE: "bad",
}


@dataclass(frozen=True, slots=True)
class ShownFinding:
    """One line of a report."""

    css: str
    level: str
    kind: str
    title: str
    text: str


def shown_findings(findings: Sequence[Finding]) -> list[ShownFinding]:
    """The lines of a report: the first of each kind, and how many more there are."""
    seen: Counter[str] = Counter()
    lines = []
    for one in findings:
        seen[one.kind] += 1
        if seen[one.kind] <= FINDING_LISTS.most_of_a_kind:
            lines.append(_line(one, whole_text(one)))
        elif seen[one.kind] == FINDING_LISTS.most_of_a_kind + 1:
            more = sum(other.kind == one.kind for other in findings) - FINDING_LISTS.most_of_a_kind
            lines.append(_line(one, f"{more} more of this kind stand in summary.json."))
    return lines


def _line(one: Finding, text: str) -> ShownFinding:
    return ShownFinding(
        LEVEL_STYLES[one.level], str(one.level), str(one.kind), title_of(one.kind), text
    )
