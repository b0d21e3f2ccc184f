"""A finding: what contradicts or confirms a map, as a record without prose."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

import msgspec

from recon4.model.finding_kinds import FindingKind

Value = bool | int | float | str
Point = tuple[float, float, float]
_PLACES = {kind: place for place, kind in enumerate(FindingKind)}


class Level(StrEnum):
    """What a finding means for the use of the map; in this order."""

    GOOD = "good"
    """It confirms the map."""
    NOTE = "note"
    """Worth to know; the verdict is not affected."""
    CHECK = "check"
    DO_NOT_USE = "do not use"

    @property
    def rank(self) -> int:
        """0 = good … 3 = do not use."""
        return list(Level).index(self)


class Finding(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """One finding. ``recon4.findings.wording`` puts it into words."""

    kind: FindingKind
    level: Level
    span_s: tuple[float, float] | None = None
    """Its stretch of the walk: after the first multiframe or scan [s]; None = the whole walk."""
    place_m: tuple[Point, Point] | None = None
    """Positions in the map at both ends of the stretch [m]; None = not known."""
    direction: str = ""
    """Direction that it is about: ``horizontal``, ``vertical``, an axis of the body; empty = none.
    """
    sensor: str = ""
    """Name of the sensor in the rig file; empty = none."""
    values: dict[str, Value] = {}
    """Figures and words that its text quotes, in SI units and radians; a value that is not known is
    left out."""

    @property
    def is_reason(self) -> bool:
        """Whether it makes the verdict worse than good."""
        return self.level.rank >= Level.CHECK.rank


def worst_first(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """The findings in the order in which they are shown, whatever found them.

    The worst level comes first, within it the kinds in the order of their list. Those of one kind
    stay in order.
    """
    return tuple(sorted(findings, key=lambda one: (-one.level.rank, _PLACES[one.kind])))
