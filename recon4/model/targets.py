"""Kinds of survey targets that are recognized in a cloud of points."""

from __future__ import annotations

from enum import StrEnum


class TargetKind(StrEnum):
    """What a survey target is."""

    PLATE = "plate"
    """Flat and retro-reflective; its middle is the point."""
    BOARD = "board"
    """Black-white, of four sectors; where they meet is the point."""
    SPHERE = "sphere"
    """Its middle is the point."""
