"""Logs of NovAtel receivers (OEM6, OEM7), binary and ASCII: BESTPOS, INSPVAX, INSPVA."""

from __future__ import annotations

import math
import struct
import zlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from recon4.model.derived_kinds import DerivedKind
from recon4.model.samples import GnssQuality
from recon4.recording.gnss.records import FixRows, week_ns
from recon4.recording.gnss.tuning import GNSS_FILES
from recon4.recording.report import ImportReport
from recon4.units import DAY_NS
from recon4.untrusted.bounded import parse_float

_SHORT_HEAD = struct.Struct("<3sBHHI")
"""Sync, length, message, week, milliseconds."""
LONG_SYNC, SHORT_SYNC = b"\xaa\x44\x12", b"\xaa\x44\x13"
_NO_TIME = (20, "UNKNOWN")
_FIXED, _FLOAT = GnssQuality.RTK_FIXED, GnssQuality.RTK_FLOAT
_TYPES: dict[int, tuple[str, GnssQuality]] = {
    1: ("FIXEDPOS", _FIXED),
    16: ("SINGLE", GnssQuality.SINGLE),
    17: ("PSRDIFF", GnssQuality.DIFFERENTIAL),
    18: ("WAAS", GnssQuality.DIFFERENTIAL),
    19: ("PROPAGATED", GnssQuality.DEAD_RECKONING),
    32: ("L1_FLOAT", _FLOAT),
    33: ("IONOFREE_FLOAT", _FLOAT),
    34: ("NARROW_FLOAT", _FLOAT),
    48: ("L1_INT", _FIXED),
    49: ("WIDE_INT", _FIXED),
    50: ("NARROW_INT", _FIXED),
    51: ("RTK_DIRECT_INS", _FIXED),
    52: ("INS_SBAS", GnssQuality.DIFFERENTIAL),
    53: ("INS_PSRSP", GnssQuality.SINGLE),
    54: ("INS_PSRDIFF", GnssQuality.DIFFERENTIAL),
    55: ("INS_RTKFLOAT", _FLOAT),
    56: ("INS_RTKFIXED", _FIXED),
    68: ("PPP_CONVERGING", GnssQuality.DIFFERENTIAL),
    69: ("PPP", _FLOAT),
    73: ("INS_PPP_CONVERGING", GnssQuality.DIFFERENTIAL),
    74: ("INS_PPP", _FLOAT),
    77: ("PPP_BASIC_CONVERGING", GnssQuality.DIFFERENTIAL),
    78: ("PPP_BASIC", GnssQuality.DIFFERENTIAL),
    79: ("INS_PPP_BASIC_CONVERGING", GnssQuality.DIFFERENTIAL),
    80: ("INS_PPP_BASIC", GnssQuality.DIFFERENTIAL),
}
"""Types of positions: their number in binary logs, name in ASCII ones, and quality."""
_NO_TYPE = ("NONE", GnssQuality.INVALID)
_BY_NAME = dict(_TYPES.values())
_INS_GOOD = (3, "INS_SOLUTION_GOOD")
_INS_USABLE = (*_INS_GOOD, 6, "INS_SOLUTION_FREE", 7, "INS_ALIGNMENT_COMPLETE")


@dataclass(frozen=True, slots=True)
class _Log:
    """A log that is read: its fields in order, and where those are that matter."""

    name: str
    id: int
    binary: struct.Struct
    """Of the fields up to the last one that matters."""


_LOGS = (
    _Log("INSPVAX", 1465, struct.Struct("<IIdddf6d3f")),
    _Log("BESTPOS", 42, struct.Struct("<IIdddfI3f")),
    _Log("INSPVAS", 508, struct.Struct("<Id3d3d3dI")),
    _Log("INSPVA", 507, struct.Struct("<Id3d3d3dI")),
)
"""What tells most comes first."""
_BY_ID = {log.id: log for log in _LOGS}
_BY_LOG_NAME = {log.name: log for log in _LOGS}


class NovatelLogs:
    """Collects the positions of a log, in each kind of message."""

    def __init__(self, report: ImportReport) -> None:
        self._report = report
        self._rows = {log.name: FixRows() for log in _LOGS}
        self.messages = 0
        """Whole ones of any kind."""

    def take(self, data: bytes, at: int) -> int:
        """Read a binary message at its sync bytes; where the next one may begin."""
        short = data[at : at + 3] == SHORT_SYNC
        head = _SHORT_HEAD.size if short else data[at + 3] if at + 3 < len(data) else 0
        if at + max(head, _SHORT_HEAD.size) + 4 > len(data):
            return at + 3
        length = data[at + 3] if short else int.from_bytes(data[at + 8 : at + 10], "little")
        end = at + head + length + 4
        if end > len(data):
            return at + 3
        if _checksum(data[at : end - 4]) != int.from_bytes(data[end - 4 : end], "little"):
            self._report.count("gnss_messages_damaged")
            return at + 3
        self.messages += 1
        log = _BY_ID.get(int.from_bytes(data[at + 4 : at + 6], "little"))
        body = data[at + head : end - 4]
        if log is not None and len(body) >= log.binary.size:
            week, ms = struct.unpack_from("<HI", data, at + (6 if short else 14))
            untimed = not short and data[at + 13] in _NO_TIME
            fields = log.binary.unpack_from(body)
            self._add(log, fields, week=-1 if untimed else week, second_ns=ms * 1_000_000)
        return end

    def take_text(self, line: bytes) -> None:
        """Read an ASCII log, from ``#`` or ``%`` to its checksum."""
        head, _, rest = line[1:].partition(b";")
        name = head.partition(b",")[0].decode("ascii", "replace").removesuffix("A")
        log = _BY_LOG_NAME.get(name)
        if log is None:
            return
        text, _, checksum = line[1:].rpartition(b"*")
        try:
            if _checksum(text) != int(checksum.strip()[:8], 16):
                raise ValueError("checksum")
            self.messages += 1
            of_head = head.decode("ascii").split(",")
            untimed = line[:1] == b"#" and of_head[4] in _NO_TIME
            week, second = of_head[5:7] if line[:1] == b"#" else of_head[1:3]
            cells = rest.rpartition(b"*")[0].decode("ascii").split(",")
            fields = [_field(cell) for cell in cells]
            second_ns = round(parse_float(second) * 1e3) * 1_000_000
            self._add(log, fields, week=-1 if untimed else int(week), second_ns=second_ns)
        except (ValueError, IndexError, TypeError, OverflowError, UnicodeDecodeError):
            self._report.count("gnss_messages_damaged")

    def best(self) -> tuple[str, FixRows]:
        """The kind of message that tells most, and its fixes; says which others are not read."""
        found = Counter({name: len(rows) for name, rows in self._rows.items() if len(rows)})
        name = next((log.name for log in _LOGS if log.name in found), "")
        others = ", ".join(f"{other} ({count})" for other, count in found.items() if other != name)
        if others:
            self._report.derive(DerivedKind.POSITIONS_CHOSEN, message=name, others=others)
        return name, self._rows.get(name, FixRows())

    def _add(self, log: _Log, fields: Sequence[object], *, week: int, second_ns: int) -> None:
        """Keep a fix; raises TypeError or IndexError if a field is no number."""
        if not 0 <= week <= GNSS_FILES.most_weeks or not 0 <= second_ns < 7 * DAY_NS:
            self._report.count("gnss_no_fix")
            return
        values, quality, rpy = _READERS[log.name](fields)
        if not quality:
            self._report.count("gnss_no_fix")
            return
        self._rows[log.name].add(week_ns(week, second_ns), values, quality, rpy_deg=rpy)


_Fix = tuple[tuple[float, ...], int, tuple[float, ...]]


def _bestpos(fields: Sequence[object]) -> _Fix:
    """Height above sea level plus undulation; σ of latitude, longitude and height."""
    solved = fields[0] in (0, "SOL_COMPUTED")
    lat, lon, height, undulation = _floats(fields[2:6])
    north, east, up = _floats(fields[7:10])
    quality = _quality(fields[1]) if solved else GnssQuality.INVALID
    return (lat, lon, height + undulation, *_known(east, north, up)), quality, ()


def _inspvax(fields: Sequence[object]) -> _Fix:
    lat, lon, height, undulation = _floats(fields[2:6])
    north, east, up = _floats(fields[12:15])
    usable = fields[0] in _INS_USABLE
    quality = _quality(fields[1]) if usable else GnssQuality.INVALID
    values = (lat, lon, height + undulation, *_known(east, north, up))
    return values, quality, _floats(fields[9:12]) if fields[0] in _INS_GOOD else ()


def _inspva(fields: Sequence[object]) -> _Fix:
    """Ellipsoidal height; it states neither the kind of the fix nor an accuracy."""
    lat, lon, height = _floats(fields[2:5])
    status = fields[11]
    quality = GnssQuality.SINGLE if status in _INS_USABLE else GnssQuality.INVALID
    rpy = _floats(fields[8:11]) if status in _INS_GOOD else ()
    return (lat, lon, height, math.nan, math.nan, math.nan), quality, rpy


_READERS = {"BESTPOS": _bestpos, "INSPVAX": _inspvax, "INSPVA": _inspva, "INSPVAS": _inspva}


def _quality(kind: object) -> GnssQuality:
    if isinstance(kind, str):
        return _BY_NAME.get(kind, GnssQuality.INVALID)
    return _TYPES.get(kind, _NO_TYPE)[1] if isinstance(kind, int) else _NO_TYPE[1]


def _floats(fields: Sequence[object]) -> tuple[float, ...]:
    found = tuple(float(one) for one in fields if isinstance(one, int | float))
    if len(found) != len(fields):
        raise TypeError("expected numbers")
    return found


def _known(*sd_m: float) -> tuple[float, ...]:
    return sd_m if min(sd_m) > 0.0 else (math.nan,) * 3


def _field(cell: str) -> object:
    try:
        return parse_float(cell)
    except ValueError:
        return cell


def _checksum(data: bytes) -> int:
    """NovAtel's CRC-32: that of zip files, without its complements."""
    return zlib.crc32(data, 0xFFFFFFFF) ^ 0xFFFFFFFF
