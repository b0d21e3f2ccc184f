"""Messages about files that are not as they were written."""

from __future__ import annotations

from collections.abc import Iterable, Set

from recon4.locales.coded import CodedText


def other_names(there: Set[str], expected: Iterable[str]) -> list[str]:
    """Messages about files that are missing, and about those that are not expected."""
    known = set(expected)
    damage: list[str] = [CodedText("damage-missing", name=one) for one in sorted(known - there)]
    return damage + [CodedText("damage-unexpected", name=one) for one in sorted(there - known)]
