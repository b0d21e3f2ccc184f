"""Positions of GNSS receivers in files: the one table of formats."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import RecordingError
from recon4.recording.gnss.applanix import is_sbet, read_sbet
from recon4.recording.gnss.exported_text import is_exported_text, read_exported_text
from recon4.recording.gnss.receiver_logs import is_receiver_log, read_receiver_log
from recon4.recording.gnss.records import GnssFile
from recon4.recording.gnss.rtklib import is_rtklib, read_rtklib
from recon4.recording.gnss.tuning import GNSS_FILES
from recon4.recording.report import ImportReport
from recon4.recording.samples.csv_files import read_gnss_csv
from recon4.recording.tables.text import text_encoding
from recon4.untrusted.bounded import open_regular


@dataclass(frozen=True, slots=True)
class GnssFormat:
    """A format: what tells it, and its reader."""

    title: str
    detects: Callable[[bytes, int], bool]
    """Of the first bytes, and the size of the file."""
    read: Callable[[Path, ImportReport], GnssFile]


def _text(detects: Callable[[str], bool]) -> Callable[[bytes, int], bool]:
    return lambda head, size: detects(head.decode(text_encoding(head), errors="replace"))


GNSS_FORMATS = (
    GnssFormat("RTKLIB", _text(is_rtklib), read_rtklib),
    GnssFormat("Inertial Explorer", _text(is_exported_text), read_exported_text),
    GnssFormat("SBET", is_sbet, read_sbet),
    GnssFormat("UBX, NovAtel, NMEA", lambda head, size: is_receiver_log(head), read_receiver_log),
)
"""All but tables (CSV), which the names of their columns tell."""


def is_gnss_file(path: Path) -> bool:
    """Whether a file has one of these formats."""
    return _format_of(path) is not None


def read_gnss(path: Path, report: ImportReport | None = None) -> GnssFile:
    """Read positions of any known format; a file of none of them must be a table (CSV).

    Args:
        path: The file.
        report: Gets counts and what was derived; None = not wanted.

    Raises:
        CorruptFile, EmptyRecording: If it is damaged or has no position.
        UnknownFormat: If it has no known format, naming the columns of a table.
    """
    report = report or ImportReport()
    found = _format_of(path)
    if found is not None:
        return found.read(path, report)
    return GnssFile(read_gnss_csv(path, report), "CSV")


def _format_of(path: Path) -> GnssFormat | None:
    try:
        with open_regular(path) as file:
            head = file.read(GNSS_FILES.head_bytes)
            size = path.stat().st_size
    except (RecordingError, OSError):
        return None  # the reader of tables says why
    return next((one for one in GNSS_FORMATS if one.detects(head, size)), None)
