"""The verdict on a map: good, check, or do not use, with its reasons.

It is worked out in one place, from the findings of the report, and stands in ``summary.json``, on
the terminal, in the report and on the pages.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.model.trajectory import Times, Trajectory
from recon4.model.usability import MapVerdict, Unobserved, Usability
from recon4.report.artifacts import Results, read_results
from recon4.report.drift import DriftClosed, closed_drift
from recon4.report.facts import ReportFacts
from recon4.report.findings import Finding, Level, find
from recon4.report.observability import WeakStretch, weak_stretches

_USABILITY = {
    Level.GOOD: Usability.GOOD,
    Level.NOTE: Usability.GOOD,
    Level.WARNING: Usability.CHECK,
    Level.BAD: Usability.DO_NOT_USE,
}


@dataclass(frozen=True, slots=True, eq=False)
class Assessment:
    """What the report and the summary say of a run, from one reading of its artifacts."""

    facts: ReportFacts
    results: Results
    drift: DriftClosed | None
    """Correction of the odometry; None without both trajectories."""
    findings: Sequence[Finding]
    """Worst first."""
    verdict: MapVerdict


def assess(facts: ReportFacts) -> Assessment:
    """Read the artifacts of a run once and judge its map.

    Raises:
        StoreError: If an artifact is damaged.
    """
    results = read_results(facts.artifacts)
    drift = closed_drift(results)
    findings = find(facts, results, drift)
    verdict = map_verdict(findings, unobserved=unobserved(results))
    return Assessment(facts, results, drift, findings=findings, verdict=verdict)


def map_verdict(
    findings: Sequence[Finding], *, unobserved: Sequence[Unobserved] = ()
) -> MapVerdict:
    """The worst finding decides. Without any finding nothing was checked: not good."""
    if not findings:
        return MapVerdict(Usability.CHECK, ("Nothing of this map could be checked.",))
    worst = max(finding.level for finding in findings)
    reasons = [finding for finding in findings if finding.level >= Level.WARNING]
    ordered = sorted(reasons, key=lambda finding: -finding.level)
    texts = tuple(finding.text for finding in ordered)
    return MapVerdict(_USABILITY[worst], texts, tuple(unobserved))


def unobserved(results: Results) -> tuple[Unobserved, ...]:
    """The stretches along which one direction is hardly observed, with their places in the map."""
    return tuple(
        _located(stretch, results) for stretch in weak_stretches(results.steps, results.support)
    )


def _located(stretch: WeakStretch, results: Results) -> Unobserved:
    t_ns = int(results.steps["t_mid_ns"][0]) + np.rint(
        1e9 * np.array([stretch.start_s, stretch.end_s])
    ).astype(np.int64)
    known = bool(np.isfinite(stretch.direction_odom).all())
    start_m, end_m = _places(results.final, t_ns)
    return Unobserved(
        start_s=round(stretch.start_s, 2),
        end_s=round(stretch.end_s, 2),
        direction=("horizontal" if stretch.horizontal else "vertical") if known else "",
        degeneracy=float(stretch.degeneracy),
        from_m=start_m,
        to_m=end_m,
    )


def _places(walk: Trajectory | None, t_ns: Times) -> list[tuple[float, ...]]:
    """Positions at these times [m], rounded to 1 cm; empty where the trajectory has none."""
    if walk is None or not len(walk):
        return [() for _ in t_ns]
    covered = (t_ns >= walk.t_ns[0]) & (t_ns <= walk.t_ns[-1])
    at = walk.at(np.clip(t_ns, walk.t_ns[0], walk.t_ns[-1])).t
    return [
        tuple(round(float(x), 2) for x in p) if inside else ()
        for p, inside in zip(at, covered, strict=True)
    ]
