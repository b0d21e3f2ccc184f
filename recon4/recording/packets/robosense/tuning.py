"""Tuning of the packets of RoboSense."""

from __future__ import annotations

from msgspec import Struct


class RoboSenseAngleTuning(Struct, frozen=True, kw_only=True):
    """Tables of the angles of one unit."""

    tolerance_deg: float = 3.0
    """A table of angles may exceed the elevations of its model by this."""
    low_cdeg: int = -4000
    """A Helios with lasers below -40° is a 5515."""
    least_room: int = 32
    """Device packets have room for the angles of at least as many lasers."""
    stamps: int = 20
    """Packets whose stamps tell the unit of a part of a second: together they span 3 ms."""


ROBOSENSE_ANGLES = RoboSenseAngleTuning()
