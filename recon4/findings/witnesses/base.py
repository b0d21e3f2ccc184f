"""What a witness is."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping

import numpy as np
from msgspec.structs import replace

from recon4.findings.walk_record import WalkRecord
from recon4.model.finding import Finding, Level, Point, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Trajectory


class Witness(ABC):
    """Compares the artifacts of a walk with each other for one kind of fault.

    The audit asks every class of this folder that inherits from it, made without arguments.
    """

    @abstractmethod
    def check(self, walk: WalkRecord) -> Iterable[Finding]:
        """What contradicts or confirms the map; nothing where its data is missing."""


def finding(
    kind: FindingKind,
    level: Level,
    values: Mapping[str, Value] | None = None,
    *,
    span_s: tuple[float, float] | None = None,
) -> Finding:
    """A finding with the times of its stretch rounded to 10 ms."""
    rounded = (round(span_s[0], 2), round(span_s[1], 2)) if span_s else None
    return Finding(kind=kind, level=level, span_s=rounded, values=dict(values or {}))


def placed(finding: Finding, walk: Trajectory | None) -> Finding:
    """A finding with the positions at both ends of its stretch, where the walk has them."""
    if finding.place_m is not None or finding.span_s is None or walk is None or not len(walk):
        return finding
    t_ns = walk.t_ns[0] + np.rint(1e9 * np.array(finding.span_s)).astype(np.int64)
    first, last = walk.at(np.clip(t_ns, walk.t_ns[0], walk.t_ns[-1])).t
    return replace(finding, place_m=(_point(first), _point(last)))


def _point(position: np.ndarray[tuple[int], np.dtype[np.float64]]) -> Point:
    x, y, z = np.round(position, 2).tolist()
    return x, y, z
