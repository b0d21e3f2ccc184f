"""Times in Hesai packets: a date of the clock of the sensor and microseconds of its second."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.limits import LIMITS
from recon4.recording.packets.dates import dates_of
from recon4.units import SECOND_NS, SECOND_US


def is_date(date: NDArray[np.uint8], micros: NDArray[np.uint32]) -> NDArray[np.bool_]:
    """Which times can be true, (N,).

    Args:
        date: Year, month, day, hour, minute, second; or 0 and seconds in big endian, (N, 6).
        micros: Microseconds, (N,).
    """
    first, last = (1, 1, 0, 0, 0), (12, 31, 23, 59, 60)  # month, day, hour, minute, second
    calendar = ((date[:, 1:] >= first) & (date[:, 1:] <= last)).all(axis=1)
    counted = _seconds(date) < LIMITS.latest_ns // SECOND_NS
    dated = np.where(date[:, 0] == 0, counted, calendar)
    return np.asarray(dated & (micros < SECOND_US))


def time_ns(date: NDArray[np.uint8], micros: NDArray[np.uint32]) -> Times:
    """Nanoseconds since 1970 of times that can be true, (N,).

    The year counts from 1900, or from 2000 if it is below 70 (Pandar40P, Pandar64). If all
    packets are of one second, its date is taken apart once.

    Args:
        date: Year, month, day, hour, minute, second; or 0 and seconds in big endian, (N, 6).
        micros: Microseconds, (N,).
    """
    is_one = len(date) > 0 and bool((date == date[0]).all())
    seconds = _seconds_since_1970(date[:1] if is_one else date)
    return np.asarray(seconds * SECOND_NS + micros.astype(np.int64) * 1000)


def _seconds_since_1970(date: NDArray[np.uint8]) -> NDArray[np.int64]:
    field = date.astype(np.int64).T
    year = field[0] + np.where(field[0] < 70, 2000, 1900)
    month = ((year - 1970) * 12 + field[1] - 1).astype("datetime64[M]")
    day = month.astype("datetime64[D]").astype(np.int64) + field[2] - 1
    calendar = ((day * 24 + field[3]) * 60 + field[4]) * 60 + field[5]
    return np.where(field[0] == 0, _seconds(date), calendar)


def date_of(seconds: NDArray[np.int64]) -> NDArray[np.uint8]:
    """The six bytes of times in seconds since 1970: the inverse of `time_ns`, (N, 6)."""
    return (dates_of(seconds) - (1900, 0, 0, 0, 0, 0)).astype(np.uint8)


def _seconds(date: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Seconds since 1970 in the last five bytes, (N,)."""
    powers = 256 ** np.arange(4, -1, -1, dtype=np.int64)
    return np.asarray(date[:, 1:].astype(np.int64) @ powers)
