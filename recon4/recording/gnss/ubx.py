"""Messages of u-blox receivers (UBX): NAV-PVT, and NAV-HPPOSLLH with the digits that it lacks."""

from __future__ import annotations

import math
import struct
from datetime import UTC, datetime
from enum import IntEnum

import numpy as np

from recon4.model.samples import GnssQuality
from recon4.recording.gnss.records import FixRows
from recon4.recording.gnss.tuning import GNSS_FILES
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS

SYNC = b"\xb5\x62"
_PVT, _HIGH_PRECISION = b"\x01\x07", b"\x01\x14"
_PVT_HEAD = struct.Struct("<IH5BBIiBBBBiiiiII")
"""Of its 92 bytes the first 48: time of week, date, time, valid, tAcc, nano, fixType, flags,
flags2, numSV, lon, lat, height, hMSL, hAcc, vAcc."""
_HP = struct.Struct("<B2xBIiiii4bII")
"""version, flags, time of week, lon, lat, height, hMSL, their further digits, hAcc, vAcc."""


class _Ubx(IntEnum):
    """Types of fixes, and the flags of a time that is known to the second."""

    DEAD_RECKONING = 1
    FLAT = 2
    COMBINED = 4
    TIMED = 0x07


class UbxMessages:
    """Collects the positions of a log."""

    def __init__(self, report: ImportReport) -> None:
        self._report = report
        self._fixes: list[tuple[int, int, tuple[float, ...], int]] = []
        """Time of week [ms], UTC [ns], values, quality."""
        self._precise: dict[int, tuple[float, ...]] = {}
        self.messages = 0
        """Whole ones of any kind."""

    def take(self, data: bytes, at: int) -> int:
        """Read a message at its sync bytes; where the next one may begin."""
        length = int.from_bytes(data[at + 4 : at + 6], "little")
        end = at + 8 + length
        if end > len(data) or length > GNSS_FILES.longest_message:
            return at + 2
        body = data[at + 2 : end - 2]
        if _checksum(body) != data[end - 2 : end]:
            self._report.count("gnss_messages_damaged")
            return at + 2
        self.messages += 1
        if body[:2] == _PVT and length >= _PVT_HEAD.size:
            self._pvt(body[4:])
        elif body[:2] == _HIGH_PRECISION and length >= _HP.size:
            self._high_precision(body[4:])
        return end

    def rows(self) -> FixRows:
        """All fixes, on UTC."""
        rows = FixRows()
        for week_ms, t_ns, values, quality in self._fixes:
            precise = self._precise.get(week_ms)
            # The same time of week may come again a week later: the place then differs.
            if precise and max(abs(precise[k] - values[k]) for k in (0, 1)) < GNSS_FILES.same_deg:
                height_m = values[2] if math.isnan(values[2]) else precise[2]
                values = (*precise[:2], height_m, *precise[3:])
            rows.add(t_ns, values, quality)
        return rows

    def _pvt(self, body: bytes) -> None:
        found = _PVT_HEAD.unpack_from(body)
        week_ms, year, month, day, hour, minute, second, valid, _, nano = found[:10]
        fix, flags, _, _, lon, lat, height, _, flat, up = found[10:]
        quality = _quality(fix, flags)
        if valid & _Ubx.TIMED != _Ubx.TIMED or not quality:
            self._report.count("gnss_no_fix")
            return
        try:
            # A leap second is the 60th: it has no Unix time of its own.
            whole = datetime(year, month, day, hour, minute, min(second, 59), tzinfo=UTC)
        except ValueError:
            self._report.count("gnss_messages_damaged")
            return
        t_ns = int(whole.timestamp()) * SECOND_NS + nano
        height_m = math.nan if fix == _Ubx.FLAT else 1e-3 * height
        values = (1e-7 * lat, 1e-7 * lon, height_m, *_axes(1e-3 * flat), 1e-3 * up)
        self._fixes.append((week_ms, t_ns, values, quality))

    def _high_precision(self, body: bytes) -> None:
        _, invalid, week_ms, lon, lat, height, _, lon9, lat9, up4, _, flat, up = _HP.unpack_from(
            body
        )
        if invalid & 1:
            return
        degrees = (1e-7 * lat + 1e-9 * lat9, 1e-7 * lon + 1e-9 * lon9)
        height_m = 1e-3 * height + 1e-4 * up4
        self._precise[week_ms] = (*degrees, height_m, *_axes(1e-4 * flat), 1e-4 * up)


def _axes(flat_m: float) -> tuple[float, float]:
    """Standard deviation of one axis of a horizontal one by length."""
    return flat_m / math.sqrt(2.0), flat_m / math.sqrt(2.0)


def _quality(fix: int, flags: int) -> int:
    """`GnssQuality` of the type of fix and its flags; 0 = none."""
    if not flags & 1 or not _Ubx.DEAD_RECKONING <= fix <= _Ubx.COMBINED:
        return GnssQuality.INVALID
    if fix == _Ubx.DEAD_RECKONING:
        return GnssQuality.DEAD_RECKONING
    if carrier := flags >> 6:
        return GnssQuality.RTK_FIXED if carrier == 2 else GnssQuality.RTK_FLOAT
    return GnssQuality.DIFFERENTIAL if flags & 2 else GnssQuality.SINGLE


def _checksum(body: bytes) -> bytes:
    """The two bytes of Fletcher's checksum."""
    values = np.frombuffer(body, np.uint8).astype(np.int64)
    first, second = values.sum(), (values * np.arange(len(values), 0, -1)).sum()
    return bytes((int(first) & 0xFF, int(second) & 0xFF))
