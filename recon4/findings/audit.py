"""The stage ``audit``: all witnesses over the artifacts of a walk; nothing else writes findings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from importlib import import_module
from inspect import isabstract
from pathlib import Path
from pkgutil import iter_modules

import msgspec

from recon4.errors import StoreError
from recon4.findings import witnesses as folder
from recon4.findings.tuning import AUDIT_LIST
from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, placed
from recon4.locales.coded import unreadable
from recon4.model.figures import AuditFigures
from recon4.model.finding import Finding, Level, worst_first
from recon4.store.atomic import write_json
from recon4.store.json_files import read_object
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.typed import as_type

FINDINGS = "findings.json"


def witnesses() -> tuple[Witness, ...]:
    """One of each witness in the modules of `recon4/findings/witnesses/`, by module and name."""
    names = [f"{folder.__name__}.{one.name}" for one in iter_modules(folder.__path__)]
    return tuple(
        kind()
        for module in map(import_module, names)
        for _, kind in sorted(vars(module).items())
        if isinstance(kind, type)
        and issubclass(kind, Witness)
        and kind.__module__ == module.__name__
        and not isabstract(kind)
    )


def check_walk(walk: WalkRecord) -> tuple[Finding, ...]:
    """What all witnesses find in a walk, worst first, each with its place in the map."""
    found = [placed(one, walk.final) for witness in witnesses() for one in witness.check(walk)]
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
    record = read_object(folder / FINDINGS, max_bytes=LIMITS.findings_bytes)
    try:
        return tuple(as_type(record.get("findings"), list[Finding]))
    except msgspec.ValidationError as error:
        raise StoreError(unreadable(FINDINGS, error)) from error


def _most_of_a_kind(findings: Iterable[Finding]) -> list[Finding]:
    seen: Counter[str] = Counter()
    kept = []
    for finding in findings:
        seen[finding.kind] += 1
        if seen[finding.kind] <= AUDIT_LIST.most_of_a_kind:
            kept.append(finding)
    return kept
