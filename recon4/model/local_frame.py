"""Why a map has no place on earth."""

from __future__ import annotations

from enum import StrEnum


class LocalReason(StrEnum):
    """What keeps a map in its own local frame, as ``georeference.json`` has it."""

    NO_GNSS = "no-gnss"
    """The recording has no positions."""
    SWITCHED_OFF = "switched-off"
    """``gnss.enabled`` is false."""
    FEW_FIXES = "few-fixes"
    """Too few fixes are usable."""
    NO_AGREEMENT = "no-agreement"
    """Too few fixes agree with the trajectory, or over too short a way."""
