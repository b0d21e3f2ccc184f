"""What ``summary.json`` says of the findings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import msgspec

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.model.finding import Level, Point
from recon4.untrusted.typed import as_type


@dataclass(frozen=True, slots=True, kw_only=True)
class SaidFinding:
    """A finding as `recon4.findings.wording.said` writes it."""

    kind: str
    """Its code; a later version may know more of them."""
    level: Level
    title: str
    text: str
    remedy: str = ""
    """What to do about it; empty = nothing."""
    span_s: tuple[float, float] | None = None
    """Its stretch of the walk: after the first multiframe or scan [s]; null = the whole walk."""
    place_m: tuple[Point, Point] | None = None
    """Positions in the map at both ends of the stretch [m]; null = not known."""
    direction: str = ""
    sensor: str = ""
    values: dict[str, bool | int | float | str | None] = field(default_factory=dict)
    """Figures and words that its text quotes, in SI units and radians."""


def findings_in(summary: Mapping[str, object]) -> list[SaidFinding] | None:
    """The findings in ``summary.json``; None before format 3, which has none.

    Raises:
        StoreError: If they cannot be read.
    """
    record = summary.get("findings")
    if record is None:
        return None
    try:
        return as_type(record, list[SaidFinding])
    except msgspec.ValidationError as error:
        raise StoreError(CodedText("summary-findings-unreadable", why=str(error))) from error


def notes_in(summary: Mapping[str, object]) -> list[str]:
    """Texts of the findings that do not change the verdict; before format 3, of all warnings."""
    findings = summary.get("findings")
    if isinstance(findings, list):
        return [str(one.get("text", "")) for one in findings if one.get("level") == Level.NOTE]
    warnings = summary.get("warnings")
    return [str(text) for text in warnings] if isinstance(warnings, list) else []
