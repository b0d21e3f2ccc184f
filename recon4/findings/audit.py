"""The stage ``audit``: all witnesses over the artifacts of a walk; nothing else writes findings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

import msgspec

from recon4.errors import StoreError
from recon4.findings.tuning import AUDIT_LIST
from recon4.findings.walk import WalkRecord
from recon4.findings.witnesses.base import Witness, placed
from recon4.findings.witnesses.class_corrections import ClassCorrections
from recon4.findings.witnesses.imports import Earlier, Import
from recon4.findings.witnesses.imu import Gravity, ImuUse, Rides, Saturation, UpsideDown
from recon4.findings.witnesses.lines import FirstTrajectory
from recon4.findings.witnesses.loops import Correction, Decisions, Loops
from recon4.findings.witnesses.motion import Bridges, Moving, WeakTurns
from recon4.findings.witnesses.places import LookAlike, Pieces
from recon4.findings.witnesses.placing import Antenna, Gnss, Heights, Leveled, Mirrors
from recon4.findings.witnesses.rig import RigAge, RigFile
from recon4.findings.witnesses.speed import Speed
from recon4.findings.witnesses.tracking import Convergence, Tracking
from recon4.findings.witnesses.turn_scale import TurnScales
from recon4.findings.witnesses.uncertainty import Uncertainty
from recon4.findings.witnesses.weak_directions import WeakStretches
from recon4.model.figures import AuditFigures
from recon4.model.finding import Finding, Level, worst_first
from recon4.settings.reads import AuditReads
from recon4.store.atomic import write_json
from recon4.untrusted.bounded import read_json_object
from recon4.untrusted.limits import LIMITS

FINDINGS = "findings.json"


def witnesses(settings: AuditReads) -> tuple[Witness, ...]:
    """All witnesses of a 3-D map, in the order in which findings of one level are shown."""
    return (
        Tracking(),
        Convergence(),
        WeakStretches(),
        RigFile(),
        RigAge(settings.rig.max_age_days),
        Uncertainty(),
        Pieces(),
        LookAlike(),
        TurnScales(),
        Speed(),
        Loops(),
        Correction(),
        Leveled(),
        Gnss(),
        Heights(settings.gnss),
        Antenna(),
        Mirrors(),
        ClassCorrections(),
        Import(),
        Rides(),
        Saturation(),
        Gravity(),
        UpsideDown(),
        ImuUse(),
        Moving(),
        WeakTurns(),
        Bridges(),
        FirstTrajectory(),
        Decisions(),
        Earlier(),
    )


def check_walk(walk: WalkRecord, settings: AuditReads) -> tuple[Finding, ...]:
    """What all witnesses find in a walk, worst first, each with its place in the map."""
    found = [
        placed(one, walk.final)
        for witness in witnesses(settings)
        for one in witness.check(walk)
    ]  # fmt: skip
    return worst_first(_most_of_a_kind(found))


def save_findings(folder: Path, findings: Sequence[Finding]) -> AuditFigures:
    """Write ``findings.json``."""
    write_json(folder / FINDINGS, {"format": 1, "findings": msgspec.to_builtins(findings)})
    levels = Counter(finding.level for finding in findings)
    return AuditFigures(findings={str(level): levels[level] for level in Level})


def load_findings(folder: Path) -> tuple[Finding, ...]:
    """Read ``findings.json``.

    Raises:
        StoreError: If it is missing or damaged.
    """
    record = read_json_object(folder / FINDINGS, LIMITS.findings_bytes, failure=StoreError)
    try:
        return tuple(msgspec.convert(record.get("findings"), list[Finding]))
    except msgspec.ValidationError as error:
        raise StoreError(f"{FINDINGS} cannot be read: {error}") from error


def _most_of_a_kind(findings: Iterable[Finding]) -> list[Finding]:
    seen: Counter[str] = Counter()
    kept = []
    for finding in findings:
        seen[finding.kind] += 1
        if seen[finding.kind] <= AUDIT_LIST.most_of_a_kind:
            kept.append(finding)
    return kept
