"""Trajectories of Applanix (SBET), with their accuracies (smrmsg) if these lie beside them."""

from __future__ import annotations

from enum import IntEnum
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile, EmptyRecording, RecordingError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.samples import GnssQuality, GnssSamples
from recon4.recording.gnss.records import Dating, GnssFile
from recon4.recording.gnss.tuning import GNSS_FILES
from recon4.recording.report import ImportReport
from recon4.untrusted.bounded import check_file_size, open_regular


class _Sbet(IntEnum):
    """Columns of a trajectory, and how many there are."""

    TIME = 0
    LAT = 1
    LON = 2
    HEIGHT = 3
    ROLL = 7
    PITCH = 8
    HEADING = 9
    WANDER = 10
    COLUMNS = 17


class _Rms(IntEnum):
    """Columns of accuracies, and how many there are."""

    TIME = 0
    NORTH = 1
    EAST = 2
    DOWN = 3
    COLUMNS = 10


def is_sbet(head: bytes, size: int) -> bool:
    """Whether bytes are rows of 17 numbers that can be times, places and attitudes.

    The format has no mark of its own.

    Args:
        head: The first bytes of a file.
        size: Of the file.
    """
    row_bytes = 8 * _Sbet.COLUMNS
    count = min(len(head) // row_bytes, GNSS_FILES.judged_rows)
    if not count or size % row_bytes:
        return False
    rows = np.frombuffer(head, "<f8", count * _Sbet.COLUMNS).reshape(count, _Sbet.COLUMNS)
    if not np.isfinite(rows).all():
        return False
    step_s = np.diff(rows[:, 0])
    small = np.abs(
        rows[:, [_Sbet.LAT, _Sbet.LON, _Sbet.ROLL, _Sbet.PITCH, _Sbet.HEADING, _Sbet.WANDER]]
    )
    # A week may end in the file: its seconds then count on.
    return bool(
        (rows[:, 0] >= 0.0).all()
        and (rows[:, 0] < 2 * GNSS_FILES.week_s).all()
        and ((step_s > 0.0) & (step_s < GNSS_FILES.longest_step_s)).all()
        and (small <= [np.pi / 2, 2 * np.pi, np.pi, np.pi / 2, 2 * np.pi, 2 * np.pi]).all()
        and small[:, :2].any()
        and (np.abs(rows[:, _Sbet.HEIGHT]) < 1e5).all()
    )


def read_sbet(path: Path, report: ImportReport) -> GnssFile:
    """Read a smoothed trajectory: positions, attitudes, accuracies of an smrmsg file beside it.

    Without accuracies a position counts as a single fix with the usual error of one.

    Args:
        path: Rows of 17 doubles, little-endian: seconds of the GPS week, radians, meters. The
            platform is turned from north by its heading minus the wander angle.
        report: Gets what was found beside it.

    Raises:
        CorruptFile: If a row is no place.
        EmptyRecording: If there is none.
    """
    rows = _rows(path, _Sbet.COLUMNS)
    if not np.isfinite(rows[:, :11]).all():
        bad = int(np.flatnonzero(~np.isfinite(rows[:, :11]).all(axis=1))[0])
        raise CorruptFile(
            CodedText("sbet-not-finite", file=path.name, bad=bad + 1, rows=str(rows[bad]))
        )
    sd_m = _accuracies(path, rows[:, 0], report)
    flat_m = np.linalg.norm(sd_m[:, :2], axis=1)
    quality = np.select(
        [flat_m <= GNSS_FILES.fixed_m, flat_m <= GNSS_FILES.float_m],
        [np.uint8(GnssQuality.RTK_FIXED), np.uint8(GnssQuality.RTK_FLOAT)],
        np.uint8(GnssQuality.SINGLE),
    )
    heading = (rows[:, _Sbet.HEADING] - rows[:, _Sbet.WANDER]) % (2.0 * np.pi)
    samples = GnssSamples(
        np.rint(rows[:, 0] * 1e9).astype(np.int64),
        rows[:, _Sbet.LAT].copy(),
        rows[:, _Sbet.LON].copy(),
        rows[:, _Sbet.HEIGHT].copy(),
        sd_m,
        quality,
        np.column_stack([rows[:, _Sbet.ROLL], rows[:, _Sbet.PITCH], heading]),
    )
    return GnssFile(samples, "SBET", Dating.WEEK)


def _rows(path: Path, columns: int) -> Array:
    """Rows of doubles, (N, columns)."""
    with open_regular(path) as file:
        size = check_file_size(file, path, GNSS_FILES.sbet_bytes)
        if size % (8 * columns):
            raise CorruptFile(CodedText("sbet-cut", file=path.name, columns=8 * columns, size=size))
        if not size:
            raise EmptyRecording(CodedText("file-empty", name=path.name))
        return np.fromfile(file, "<f8").reshape(-1, columns)


def _accuracies(path: Path, at_s: Array, report: ImportReport) -> Array:
    """Standard deviations east, north, up [m] at times, (N, 3); NaN = not stated."""
    nothing = np.full((len(at_s), 3), np.nan)
    beside = next((file for file in _named_alike(path) if file.is_file()), None)
    if beside is None:
        report.derive(DerivedKind.POSITIONS_ACCURACY, name=path.name, absent=True)
        return nothing
    try:
        rms = _rows(beside, _Rms.COLUMNS)
    except RecordingError as error:
        report.derive(DerivedKind.POSITIONS_ACCURACY, name=path.name, error=error)
        return nothing
    sound = np.isfinite(rms[:, :4]).all(axis=1) & (
        rms[:, [_Rms.NORTH, _Rms.EAST, _Rms.DOWN]] > 0.0
    ).all(axis=1)
    rms = rms[sound][np.argsort(rms[sound, 0], kind="stable")]
    if not len(rms):
        report.derive(DerivedKind.POSITIONS_ACCURACY, name=beside.name, no_number=True)
        return nothing
    axes = (_Rms.NORTH, _Rms.EAST, _Rms.DOWN)
    north, east, down = (np.interp(at_s, rms[:, 0], rms[:, k]) for k in axes)
    near = np.clip(np.searchsorted(rms[:, 0], at_s), 1, max(len(rms) - 1, 1))
    gap_s = np.minimum(
        np.abs(rms[near - 1, 0] - at_s), np.abs(rms[np.minimum(near, len(rms) - 1), 0] - at_s)
    )
    report.derive(DerivedKind.POSITIONS_ACCURACY, name=path.name, source=beside.name)
    found = np.column_stack([east, north, down])
    return np.where((gap_s <= GNSS_FILES.rms_gap_s)[:, None], found, np.nan)


def _named_alike(path: Path) -> tuple[Path, ...]:
    """Names that programs give the accuracies of a trajectory."""
    names = [path.with_suffix(".smrmsg")]
    for word, other in (("sbet", "smrmsg"), ("SBET", "SMRMSG")):
        if word in path.name:
            renamed = path.with_name(path.name.replace(word, other))
            names += [renamed, renamed.with_suffix(".out"), renamed.with_suffix(".smrmsg")]
    return tuple(dict.fromkeys(name for name in names if name != path))
