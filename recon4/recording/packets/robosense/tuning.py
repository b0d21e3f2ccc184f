"""Tuning of the packets of RoboSense."""

from __future__ import annotations

from msgspec import Struct


class RoboSenseAngleTuning(Struct, frozen=True, kw_only=True):
    """Tables of the angles of one unit."""

    tolerance_deg: float = 3.0
    """A table of angles may exceed the elevations of its model by this."""
    low_cdeg: int = -4000
    """A Helios with lasers below -40° is a 5515."""


ROBOSENSE_ANGLES = RoboSenseAngleTuning()
