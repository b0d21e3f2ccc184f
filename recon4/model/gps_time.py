"""UTC and GPS time."""

from __future__ import annotations

from datetime import UTC, date, datetime

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times
from recon4.units import SECOND_NS

_LEAPS = (
    "1981-07-01 1982-07-01 1983-07-01 1985-07-01 1988-01-01 1990-01-01 1991-01-01 1992-07-01 "
    "1993-07-01 1994-07-01 1996-01-01 1997-07-01 1999-01-01 2006-01-01 2009-01-01 2012-07-01 "
    "2015-07-01 2017-01-01"
)
"""Days that began with GPS time one second farther ahead of UTC: IERS Bulletin C, all since 1980.

After the last one GPS is 18 s ahead. A leap second announced later is one more date here.
"""


def _utc_ns(day: str) -> int:
    return int(datetime.fromisoformat(day).replace(tzinfo=UTC).timestamp()) * 10**9


GPS_MINUS_UTC_S = len(_LEAPS.split())
"""How far GPS time is ahead of UTC now [s]."""
GPS_EPOCH_NS = _utc_ns("1980-01-06")
_LEAP_NS = np.array([_utc_ns(day) for day in _LEAPS.split()], dtype=np.int64)


def is_absolute(t_ns: int) -> bool:
    """Whether a time can be UTC: a clock that started with the recording is before 1980."""
    return t_ns >= GPS_EPOCH_NS


def adjusted_gps_s(t_ns: Times) -> Array:
    """Adjusted standard GPS time of LAS 1.4: GPS seconds minus 10^9, to 0.1 us.

    Args:
        t_ns: UTC since 1970 without leap seconds (Unix time) [ns], (N,).
    """
    leaps_ns = np.searchsorted(_LEAP_NS, t_ns, side="right") * 10**9
    return (t_ns - GPS_EPOCH_NS + leaps_ns - 10**9 * SECOND_NS) / 1e9


def utc_of_gps_ns(t_gps_ns: Times) -> Times:
    """UTC since 1970 without leap seconds [ns] of GPS time, (N,).

    Args:
        t_gps_ns: GPS time since 1970: `GPS_EPOCH_NS` and what passed since then [ns], (N,).
    """
    ahead = np.arange(1, len(_LEAP_NS) + 1) * 10**9
    leaps_ns = np.searchsorted(_LEAP_NS + ahead, t_gps_ns, side="right") * 10**9
    return t_gps_ns - leaps_ns


def point_time_s(t_ns: Times, *, absolute: bool) -> Array:
    """`adjusted_gps_s`, or seconds of the recording's own clock."""
    return adjusted_gps_s(t_ns) if absolute else t_ns / 1e9


def day_of(t_ns: int) -> date:
    """The UTC day of a time."""
    return datetime.fromtimestamp(t_ns // 10**9, UTC).date()
