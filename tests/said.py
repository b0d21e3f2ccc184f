"""Findings in words, as people read them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from recon4.findings.audit import check_walk
from recon4.findings.verdict import verdict_of
from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.lines import line_findings
from recon4.findings.witnesses.rig import agreement, rig_findings
from recon4.findings.wording import whole_text
from recon4.model.calibration_figures import CalibrationFigures
from recon4.model.finding import Finding
from recon4.model.odometry_figures import OdometryFigures
from recon4.model.usability import MapVerdict
from recon4.settings import Settings
from recon4.settings.reads import AuditReads, part_of


def texts(findings: Iterable[Finding]) -> list[str]:
    """Each finding with its remedy."""
    return [whole_text(one) for one in findings]


def rig_texts(figures: CalibrationFigures) -> list[str]:
    """What an audit of the rig says."""
    return texts(rig_findings(figures))


def outcome_text(figures: CalibrationFigures) -> str:
    """What came of the calibration of a rig."""
    return whole_text(agreement(figures.outcome, figures.statuses))


def line_texts(figures: OdometryFigures) -> list[str]:
    """What the odometry of a rig with a profiler says."""
    assert figures.lines is not None
    return texts(line_findings(figures.lines))


def found_in(walk: WalkRecord, settings: Settings | None = None) -> tuple[Finding, ...]:
    """What all witnesses find in a walk."""
    return check_walk(replace(walk, settings=part_of(settings, AuditReads)) if settings else walk)


def odometry_findings(figures: OdometryFigures) -> list[Finding]:
    """What the witnesses make of the odometry alone."""
    empty = set(texts(found_in(WalkRecord())))
    walk = replace(WalkRecord(), odometry_figures=figures)
    return [one for one in found_in(walk) if whole_text(one) not in empty]


def judged(walk: WalkRecord, settings: Settings | None = None) -> MapVerdict:
    """The verdict on a walk."""
    return verdict_of(found_in(walk, settings))
