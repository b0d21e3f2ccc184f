"""Stretches of the walk that findings of a capture are about, as positions for the phone."""

from __future__ import annotations

import math
from typing import Literal

import msgspec

from recon4.live.tuning import STRETCHES

StretchKind = Literal["TRACKING-LOST", "WEAK-DIRECTION"]


class MarkedStretch(msgspec.Struct):
    """Where a walk had a problem."""

    kind: StretchKind
    """Code of the finding."""
    p: list[list[float]]
    """Positions as they were mapped then [m], a position every `STRETCHES.step_m`."""


class Stretches:
    """The stretches of a walk, from the positions of its poses."""

    def __init__(self) -> None:
        self.marked: list[MarkedStretch] = []
        self.changed = 0
        """How often any has changed."""
        self._open: MarkedStretch | None = None
        """The one that goes on; among `marked` once it is known to count."""

    def take(self, kind: StretchKind | None, p: list[float], *, counts: bool) -> None:
        """Add a position.

        Args:
            kind: Of the problem there; None = none, a stretch ends.
            p: Position [m].
            counts: Whether the stretch is long enough for a finding.
        """
        if kind is None:
            self._open = None
            return
        before = self._open
        if before is None or before.kind != kind or len(before.p) >= STRETCHES.most_positions:
            goes_on = before is not None and before.kind == kind
            self._open = MarkedStretch(kind, before.p[-1:] if before and goes_on else [])
        assert self._open is not None
        grown = self._extend(self._open.p, p)
        if (
            counts
            and not self._is_marked(self._open)
            and len(self.marked) < STRETCHES.most_stretches
        ):
            self.marked.append(self._open)
            grown = True
        self.changed += grown and self._is_marked(self._open)

    def _is_marked(self, one: MarkedStretch) -> bool:
        return bool(self.marked) and self.marked[-1] is one

    @staticmethod
    def _extend(places: list[list[float]], p: list[float]) -> bool:
        if places and math.dist(places[-1], p) < STRETCHES.step_m:
            return False
        places.append([round(value, 2) for value in p])
        return True
