"""What readers warn of and derive, for tests: kinds and values, or the words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from recon4.findings.derived import derived_text
from recon4.findings.wording import whole_text
from recon4.model.finding import Finding
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_notes import derived_in, import_notes

K = FindingKind


def findings_of(where: Any) -> tuple[Finding, ...]:
    """The warnings in an import report, in contents of a recording, or in ``report.json``."""
    return import_notes(where).findings if isinstance(where, Mapping) else tuple(where.findings)


def kinds(where: Any) -> list[FindingKind]:
    """The kinds of all warnings, in order."""
    return [one.kind for one in findings_of(where)]


def warned(where: Any, kind: FindingKind, **values: object) -> bool:
    """Whether there is a warning of a kind that has these values; texts contain what is given."""
    return any(one.kind is kind and _has(one, values) for one in findings_of(where))


def words(where: Any) -> str:
    """All warnings in words."""
    return " | ".join(map(whole_text, findings_of(where)))


def derivations(where: Any) -> list[str]:
    """What was derived, in words, in an import report, contents of a recording, ``report.json``."""
    found = derived_in(where) if isinstance(where, Mapping) else where.derived
    return [derived_text(one) for one in found]


def _has(found: Finding, values: Mapping[str, object]) -> bool:
    there = {"sensor": found.sensor} | found.values
    return all(_fits(there.get(name), value) for name, value in values.items())


def _fits(actual: object, expected: object) -> bool:
    if isinstance(actual, str) and isinstance(expected, str):
        return expected in actual
    if isinstance(actual, float) and isinstance(expected, float):
        return abs(actual - expected) <= 1e-3 * max(1.0, abs(expected))
    return actual == expected
