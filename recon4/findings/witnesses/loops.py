"""What loop closures make of the drift of the odometry."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from recon4.findings.drift import closed_drift
from recon4.findings.review_problems import problem_findings
from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.lines import rests
from recon4.findings.witnesses.tuning import LOOP_WITNESS
from recon4.findings.witnesses.uncertainty import is_known, known_to
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.pose_graph import EdgeKind, Verdict


class Loops(Witness):
    """Loop closures by verdict, and the chain of the odometry."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Whether the drift is corrected, and what waits for a decision."""
        if walk.graph is None:
            return
        verdicts = walk.graph.loop_verdicts()
        accepted, unverified = verdicts[Verdict.ACCEPTED], verdicts[Verdict.UNVERIFIED]
        if accepted:
            yield finding(FindingKind.LOOPS_ACCEPTED, Level.GOOD, {"accepted": accepted})
        elif not rests(walk):
            known = known_to(walk)
            yield finding(FindingKind.LOOPS_NONE, Level.NOTE if known else Level.CHECK, known)
        if unverified > accepted:
            values = {"unverified": unverified, "accepted": accepted}
            level = Level.NOTE if is_known(walk) else Level.CHECK
            yield finding(FindingKind.LOOPS_UNVERIFIED, level, values)
        broken = sum(e.kind is EdgeKind.ODOMETRY and not e.in_graph for e in walk.graph.edges)
        if broken:
            yield finding(FindingKind.CHAIN_BROKEN, Level.DO_NOT_USE, {"edges": broken})


class Correction(Witness):
    """How far the graph moved the odometry, and what loop closures say of the result."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """The correction, and loop closures that the map does not satisfy."""
        drift = closed_drift(walk)
        if drift is None:
            return
        closed = len(drift.loop_after_m) > 0
        # Without a loop closure a small correction is no evidence of small drift.
        fine = drift.largest_m <= LOOP_WITNESS.small_m and closed
        values = {"end_m": drift.end_m, "largest_m": drift.largest_m}
        yield finding(FindingKind.CORRECTION, Level.GOOD if fine else Level.NOTE, values)
        residual_m = (
            float(np.percentile(drift.loop_after_m, LOOP_WITNESS.percentile)) if closed else 0.0
        )
        if residual_m > LOOP_WITNESS.residual_m:
            yield finding(FindingKind.LOOP_RESIDUAL, Level.CHECK, {"residual_m": residual_m})


class Decisions(Witness):
    """Decisions of people that contradict the graph, or have no effect."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """What the reviewer should look at again, and whether the map has moved."""
        if walk.review is not None:
            yield from problem_findings(walk.review)
        held = walk.level.held if walk.level else None
        if held is not None and held.moved_m >= LOOP_WITNESS.held_m:
            yield finding(FindingKind.REVIEW_HELD, Level.NOTE, {"moved_m": held.moved_m})
