"""Tuning of how findings are gathered, and of what is said of a measured accuracy."""

from __future__ import annotations

from msgspec import Struct


class AuditListTuning(Struct, frozen=True, kw_only=True):
    """The list of findings of an audit."""

    most_of_a_kind: int = 200
    """No more findings of one kind are kept; the first ones are said."""
    longest_s: float = 1e9
    """Later times are not in nanoseconds of 64 bits."""


AUDIT_LIST = AuditListTuning()


class AccuracyTuning(Struct, frozen=True, kw_only=True):
    """A map against a ground truth."""

    goal_m: float = 0.05
    """Required relative error, V §3."""
    covered: float = 0.95
    """Ratio of the walk below which a ground truth is incomplete."""


ACCURACY = AccuracyTuning()
