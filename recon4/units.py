"""Physics and units: what is the same everywhere and for ever."""

from __future__ import annotations

SECOND_NS = 1_000_000_000
SECOND_US = 1_000_000
HOUR_S = 3600
HOUR_US = HOUR_S * SECOND_US
HOUR_NS = HOUR_S * SECOND_NS
DAY_NS = 24 * HOUR_NS

TURN_CDEG = 36_000
"""A full turn [0.01°]."""
CDEG_RAD = 1.7453292519943296e-4
"""0.01° [rad]."""

STANDARD_GRAVITY_M_S2 = 9.80665
EARTH_RADIUS_M = 6_371_000.0
"""Mean radius."""
MM_PER_INCH = 25.4
FOOT_M = 0.3048
"""International foot; that of the US survey differs by 2 ppm."""
