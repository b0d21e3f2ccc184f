"""What report and summary say of a run, from one reading of its artifacts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from recon4.findings.accuracy import accuracy_findings
from recon4.findings.audit import FINDINGS, check_walk, load_findings
from recon4.findings.drift import DriftClosed, closed_drift
from recon4.findings.verdict import verdict_of
from recon4.findings.walk_record import WalkRecord, read_walk
from recon4.model.finding import Finding, worst_first
from recon4.model.usability import MapVerdict
from recon4.report.facts import ReportFacts
from recon4.settings.reads import AuditReads, part_of


@dataclass(frozen=True, slots=True, eq=False)
class Assessment:
    """A run with its findings and its verdict."""

    facts: ReportFacts
    results: WalkRecord
    drift: DriftClosed | None
    """Correction of the odometry; None without both trajectories."""
    findings: Sequence[Finding]
    """Worst first."""
    verdict: MapVerdict


def assess(facts: ReportFacts) -> Assessment:
    """Read the artifacts of a run once, with what the stage ``audit`` found.

    A run of an earlier version has no such stage: its witnesses are asked here.

    Raises:
        StoreError: If an artifact is damaged.
    """
    results = read_walk(facts.artifacts, part_of(facts.settings, AuditReads))
    findings = (*_audited(facts, results), *accuracy_findings(facts.evaluation))
    ordered = worst_first(findings)
    return Assessment(
        facts, results, closed_drift(results), findings=ordered, verdict=verdict_of(ordered)
    )


def _audited(facts: ReportFacts, results: WalkRecord) -> tuple[Finding, ...]:
    audit = facts.artifacts.get("audit")
    if audit is not None and (audit / FINDINGS).is_file():
        return load_findings(audit)
    return check_walk(results)
