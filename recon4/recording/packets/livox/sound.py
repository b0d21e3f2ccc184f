"""Which payloads are Livox packets, and the time of each on the clock of the sensor."""

from __future__ import annotations

import zlib

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.limits import LIMITS
from recon4.recording.packets.dates import dates_of
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.livox.models import (
    CRC_FROM,
    SDK1_TIME_TYPES,
    SDK1_VERSION,
    SDK2_TIME_TYPES,
    SDK2_VERSION,
    UTC_STAMP,
    UTC_TIME_TYPE,
    PointLayout,
    header_of,
)
from recon4.recording.packets.livox.tuning import LIVOX_PACKETS
from recon4.recording.report import ImportReport
from recon4.units import SECOND_US


def sound_points(
    payloads: Payloads, layout: PointLayout, report: ImportReport, *, by_crc: bool
) -> NDArray[np.bool_]:
    """Which payloads are data packets of a layout, (N,).

    Counts ``packets`` and what is dropped: ``packets_wrong_header`` (version, data type, lengths or
    time type of another packet), ``packets_wrong_stamp`` (no time) and ``packets_wrong_crc``.

    Args:
        payloads: UDP payloads of the size of the layout, (N, size).
        layout: The data type of the sensor.
        report: Receives the counts.
        by_crc: Whether the packets carry sums that are right.
    """
    report.count("packets", len(payloads))
    flagged = has_header(payloads, layout.sdk, layout.data_type, points=layout.shots)
    timed = has_stamp(payloads, layout.sdk)
    sound = flagged & timed
    report.count("packets_wrong_header", int(np.count_nonzero(~flagged)))
    report.count("packets_wrong_stamp", int(np.count_nonzero(flagged & ~timed)))
    if by_crc:
        rows = np.flatnonzero(sound)
        sound[rows] = has_crc(payloads[rows])
        report.count("packets_wrong_crc", len(rows) - int(np.count_nonzero(sound)))
    return sound


def has_header(
    payloads: Payloads, sdk: int, data_type: int, *, points: int = 1
) -> NDArray[np.bool_]:
    """Whether the headers are those of packets of a data type, (N,)."""
    headers = header_of(payloads, sdk)
    if sdk == 1:
        found = (headers["version"] == SDK1_VERSION) & (headers["data_type"] == data_type)
        return np.asarray(found & (headers["time_type"] <= SDK1_TIME_TYPES))
    found = (headers["version"] == SDK2_VERSION) & (headers["data_type"] == data_type)
    found &= (headers["length"] == payloads.shape[1]) & (headers["points"] == points)
    found &= headers["interval"] <= LIVOX_PACKETS.longest_interval
    return np.asarray(found & (headers["time_type"] <= SDK2_TIME_TYPES))


def has_stamp(payloads: Payloads, sdk: int) -> NDArray[np.bool_]:
    """Whether the stamps are times, (N,)."""
    headers = header_of(payloads, sdk)
    raw = np.ascontiguousarray(headers["stamp"])
    timed = raw.view("<u8")[:, 0] < LIMITS.latest_ns
    if sdk == 2:
        return np.asarray(timed)
    date = raw.view(UTC_STAMP)[:, 0]
    is_date = (date["month"] >= 1) & (date["month"] <= 12) & (date["day"] >= 1)
    is_date &= (date["day"] <= 31) & (date["hour"] <= 23) & (date["us"] < 3_600_000_000)
    return np.where(headers["time_type"] == UTC_TIME_TYPE, is_date & (date["year"] < 100), timed)


def has_crc(payloads: Payloads) -> NDArray[np.bool_]:
    """Whether the sums of packets of SDK2 are right: CRC-32 from the stamp to the end, (N,)."""
    stated = header_of(payloads, 2)["crc"]
    rows = np.ascontiguousarray(payloads[:, CRC_FROM:])
    return np.fromiter(map(zlib.crc32, rows), np.uint32, len(rows)) == stated


def stamps_ns(payloads: Payloads, sdk: int) -> Times:
    """Time of the first shot of each packet on the clock of the sensor [ns], (N,)."""
    headers = header_of(payloads, sdk)
    raw = np.ascontiguousarray(headers["stamp"])
    counted: Times = (raw.view("<u8")[:, 0] % LIMITS.latest_ns).astype(np.int64)
    if sdk == 2 or not (headers["time_type"] == UTC_TIME_TYPE).any():
        return counted
    date = raw.view(UTC_STAMP)[:, 0]
    months = 12 * (2000 - 1970 + date["year"].astype(np.int64)) + date["month"] - 1
    days = months.astype("M8[M]").astype("M8[D]").astype(np.int64) + date["day"] - 1
    hours = 24 * days + date["hour"]
    dated = 1000 * (3_600_000_000 * hours + date["us"])
    return np.where(headers["time_type"] == UTC_TIME_TYPE, dated, counted).astype(np.int64)


def date_stamps(t_ns: Times) -> NDArray[np.uint8]:
    """Times as date and microseconds past the hour, the inverse of `stamps_ns`, (N, 8)."""
    us = np.asarray(t_ns, np.int64) // 1000
    date = dates_of(us // SECOND_US) - (2000, 0, 0, 0, 0, 0)
    stamps = np.zeros(len(us), UTC_STAMP)
    for column, name in enumerate(("year", "month", "day", "hour")):
        stamps[name] = date[:, column]
    stamps["us"] = us % (3600 * SECOND_US)
    return stamps.view(np.uint8).reshape(-1, UTC_STAMP.itemsize)
