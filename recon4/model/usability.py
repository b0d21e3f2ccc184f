"""What a person may do with a map."""

from __future__ import annotations

from enum import StrEnum


class Usability(StrEnum):
    """Verdict on a map."""

    GOOD = "good"
    CHECK = "check"
    DO_NOT_USE = "do not use"
