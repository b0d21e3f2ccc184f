"""Settings of the estimation with a profiler: line scans, 2-D laser, IMU."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.settings.require import Checked


@dataclass(frozen=True, slots=True, kw_only=True)
class LineSettings(Checked):
    """Line scans of a profiler (requirements A12); rigs of LiDARs do not use them."""

    method: Literal["joint", "published"] = "joint"
    """``joint``: every line with the IMU between knots, distances from planes. ``published``: as
    L §4: point pairs, 6D SLAM of turns, corrections between groups of lines, no IMU."""
    preregister: bool = False
    """``published``: register each turn to the one before first (L §5.2, A12 L-5). It helps where
    2-D SLAM fails, and may bend corners that were right."""
