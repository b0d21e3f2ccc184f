"""What a receiver wrote while it ran: UBX, NovAtel and NMEA, mixed as they came."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from pathlib import Path

from recon4.errors import CorruptFile, EmptyRecording
from recon4.locales.coded import CodedText, at, text_of
from recon4.model.derived_kinds import DerivedKind
from recon4.recording.gnss.novatel import LONG_SYNC, SHORT_SYNC, NovatelLogs
from recon4.recording.gnss.records import Dating, FixRows, GnssFile
from recon4.recording.gnss.tuning import GNSS_FILES
from recon4.recording.gnss.ubx import SYNC, UbxMessages
from recon4.recording.packets.velodyne.position_packets import NmeaFix, date_of_zda, parse_fix
from recon4.recording.report import ImportReport
from recon4.recording.samples.datagrams import gst_sd_enu_m
from recon4.units import DAY_NS
from recon4.untrusted.bounded import read_bytes_limited

_SENTENCE = rb"\$[A-Z]{2}(?:GGA|RMC|GST|ZDA),[ -#%-)+-~]{6,100}(?:\*[0-9A-Fa-f]{2})?"
_ASCII_LOG = rb"[#%](?:BESTPOS|INSPVAX?|INSPVAS)A,[ -~]{20,600}"
_BEGIN = re.compile(b"|".join((re.escape(SYNC), rb"\xaaD[\x12\x13]", _SENTENCE, _ASCII_LOG)))


def is_receiver_log(head: bytes) -> bool:
    """Whether bytes have positions of a receiver: whole messages of a known kind."""
    try:
        return _collected(head, ImportReport(), head=True).messages >= GNSS_FILES.least_messages
    except CorruptFile:
        return False


@dataclass(slots=True)
class _Nmea:
    """Sentences of a log."""

    report: ImportReport
    fixes: dict[str, list[tuple[NmeaFix, bytes]]] = field(
        default_factory=lambda: {"GGA": [], "RMC": []}
    )
    """Kind of sentence -> its fixes, with the time of day as it is written."""
    sd_m: dict[int, list[float]] = field(default_factory=dict)
    """Fix of a GGA sentence, by number -> its standard deviations east, north, up."""
    near_ns: int = DAY_NS // 2
    is_dated: bool = False
    messages: int = 0
    """Whole ones."""
    _last_gst: tuple[bytes, list[float]] = (b"", [])

    def take(self, sentence: bytes) -> None:
        kind, time = sentence[3:6].decode("ascii"), sentence.split(b",", 2)[1]
        if kind == "ZDA":
            utc_ns = date_of_zda(sentence)
            self.messages += utc_ns is not None
            if utc_ns is not None:
                self._date(utc_ns)
            return
        if kind == "GST":
            self._last_gst = time, gst_sd_enu_m(sentence)
            self._match(time)
            return
        damaged = self.report.counts["nmea_damaged"]
        fix = parse_fix(sentence, self.near_ns, self.report)
        self.messages += self.report.counts["nmea_damaged"] == damaged
        if fix is None:
            return
        if kind == "RMC":
            self._date(fix.utc_ns)
        self.near_ns = fix.utc_ns
        self.fixes[kind].append((fix, time))
        self._match(time)

    def _match(self, time: bytes) -> None:
        """GST and GGA of one epoch come in any order."""
        fixes = self.fixes["GGA"]
        if fixes and fixes[-1][1] == time == self._last_gst[0]:
            self.sd_m[len(fixes) - 1] = self._last_gst[1]

    def _date(self, utc_ns: int) -> None:
        """The first date of the log: what came before is of that time."""
        shift = round((utc_ns - self.near_ns) / DAY_NS) * DAY_NS
        self.near_ns = utc_ns
        if self.is_dated:
            return
        self.is_dated = True
        for k, (fix, time) in enumerate(self.fixes["GGA"]):
            moved = NmeaFix(fix.utc_ns + shift, fix.lat_deg, fix.lon_deg, fix.height_m, fix.quality)
            self.fixes["GGA"][k] = (moved, time)

    def rows(self) -> FixRows:
        """GGA sentences; RMC sentences, which have no heights, only if there are no others."""
        rows = FixRows()
        for k, (fix, _) in enumerate(self.fixes["GGA"] or self.fixes["RMC"]):
            sd_m = self.sd_m.get(k, []) or [math.nan] * 3
            rows.add(fix.utc_ns, (fix.lat_deg, fix.lon_deg, fix.height_m, *sd_m), fix.quality)
        return rows


@dataclass(frozen=True, slots=True)
class _MixedLog:
    """All that a log holds."""

    ubx: UbxMessages
    novatel: NovatelLogs
    nmea: _Nmea

    @property
    def messages(self) -> int:
        """Whole messages of any kind."""
        return self.ubx.messages + self.novatel.messages + self.nmea.messages


def read_receiver_log(path: Path, report: ImportReport) -> GnssFile:
    """Read the positions of a log: UBX, else NovAtel, else NMEA, of which the first tell most.

    Messages whose checksum is wrong are dropped and counted (``gnss_messages_damaged``,
    ``nmea_damaged``), and so is what is no fix (``gnss_no_fix``, ``nmea_no_fix``).

    Args:
        path: The file.
        report: Gets the counts, and what of the log is not read.

    Raises:
        CorruptFile: If it is too large or cannot be read.
        EmptyRecording: If it has no position.
    """
    data = read_bytes_limited(path, GNSS_FILES.log_bytes)
    try:
        log = _collected(data, report)
    except CorruptFile as error:
        raise CorruptFile(at(path.name, text_of(error))) from error
    kind, of_novatel = log.novatel.best()
    found = {
        "UBX": log.ubx.rows(),
        f"NovAtel {kind}": of_novatel,
        "NMEA": log.nmea.rows(),
    }
    name = next((name for name, rows in found.items() if len(rows)), "")
    if not name:
        raise EmptyRecording(
            CodedText(
                "gnss-no-fix",
                file=path.name,
                counted=report.counted() or CodedText("gnss-no-message"),
            )
        )
    others = [f"{other} ({len(rows)})" for other, rows in found.items() if rows and other != name]
    if others:
        report.derive(
            DerivedKind.POSITIONS_CHOSEN, name=path.name, log=name, others=", ".join(others)
        )
    dated = name != "NMEA" or log.nmea.is_dated
    return GnssFile(
        found[name].samples(gps=name.startswith("NovAtel")),
        name,
        Dating.UTC if dated else Dating.DAY,
    )


def _collected(data: bytes, report: ImportReport, *, head: bool = False) -> _MixedLog:
    """What is in a log, or in its head: as much as tells it.

    Raises:
        CorruptFile: If most of it is damaged.
    """
    log = _MixedLog(UbxMessages(report), NovatelLogs(report), _Nmea(report))
    at, most = 0, GNSS_FILES.most_damaged_head if head else GNSS_FILES.most_damaged
    while match := _BEGIN.search(data, at):
        begin, text = match.start(), match[0]
        if report.counts["gnss_messages_damaged"] > most:
            raise CorruptFile(CodedText("gnss-checksums", most=most, begin=begin))
        if head and log.messages >= GNSS_FILES.least_messages:
            break
        if text == SYNC:
            at = log.ubx.take(data, begin)
        elif text in (LONG_SYNC, SHORT_SYNC):
            at = log.novatel.take(data, begin)
        elif text.startswith(b"$"):
            log.nmea.take(text)
            at = match.end()
        else:
            log.novatel.take_text(text)
            at = match.end()
    return log
