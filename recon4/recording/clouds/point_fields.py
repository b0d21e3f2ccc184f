"""Names of the fields of points, in any message or file; the first match wins."""

from __future__ import annotations

from typing import Any

EXACT_TIME = "t_ns"
"""Absolute times that are nanoseconds by the definition of their message: no unit is estimated."""
NS_TIME = "time [ns]"
"""Times whose unit a recipe says, of any clock or since the stamp; no field has this name."""
TIME_FIELDS = (
    NS_TIME,
    "t",
    "time",
    "timestamp",
    "time_stamp",
    "offset_time",
    "time_offset",
    "t_us",
    "gps_time",
    "gpstime",
)
RING_FIELDS = ("ring", "channel", "line", "laser_id", "beam")
INTENSITY_FIELDS = ("intensity", "i", "reflectivity", "signal", "scalar_intensity")


def find_field(names: Any, aliases: tuple[str, ...]) -> str:
    """The first alias found in the names; empty = none."""
    return next((alias for alias in aliases if alias in names), "")
