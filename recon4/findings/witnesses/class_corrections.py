"""Corrections of classes by people that do not fit the map any more."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.tuning import CLASS_CORRECTIONS
from recon4.model.figures import CorrectedClass
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind


@dataclass(frozen=True, slots=True)
class ClassCorrections(Witness):
    """What became of corrections when the map was made again with another trajectory."""

    told_m: float = CLASS_CORRECTIONS.told_m
    """A volume that followed its points farther is named [m]."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Corrections without effect, and those that moved."""
        for one in walk.map.corrections if walk.map else ():
            if not one.points:
                yield finding(FindingKind.CLASSES_NOT_CORRECTED, Level.CHECK, _values(one))
            elif one.lost:
                yield finding(FindingKind.CLASSES_MOVED, Level.CHECK, _values(one))
            elif one.moved_m is not None and one.moved_m > self.told_m:
                yield finding(FindingKind.CLASSES_MOVED, Level.NOTE, _values(one))


def _values(one: CorrectedClass) -> dict[str, Value]:
    x, y, z = one.place_m
    values: dict[str, Value] = {
        "id": one.id,
        "to": one.to,
        "who": one.who,
        "points": one.points,
        "points_then": one.points_then,
        "x_m": x,
        "y_m": y,
        "z_m": z,
        "gone": one.moved_m is None,
        "empty": one.applied,
    }
    if one.moved_m is not None and one.apart_m is not None:
        values |= {"moved_m": one.moved_m, "apart_m": one.apart_m}
    if one.lost:
        values["lost"] = one.lost
    return values | {"bent": not one.applied and one.moved_m is not None}
