"""Folders of MANDEYE devices, as HDMapping reads them: which files belong to a walk.

A walk is written in parts, each with the files ``lidarNNNN.laz`` (points of all LiDARs),
``imuNNNN.csv``, ``lidarNNNN.sn`` (lines ``id serial``) and ``statusNNNN.json`` (`status`). Sources:
HDMapping wiki, *File formats*; mandeye_controller, ``save_laz.cpp`` and ``save_data.cpp``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from recon4.errors import CorruptFile, EmptyRecording, RecordingError
from recon4.geometry.distinct import distinct
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.formats.file_times import FileTimes, require_one_walk
from recon4.recording.formats.las_records import las_header, las_points
from recon4.recording.frame_files.folders import natural
from recon4.recording.mandeye.status import DeviceStatus, read_status
from recon4.recording.mandeye.tuning import MANDEYE
from recon4.recording.report import ImportReport
from recon4.untrusted.bounded import lines_limited

POINTS_NAME = re.compile(r"lidar(\d+)\.la[sz]", re.IGNORECASE)
_POSITIONS = re.compile(r"gnss\d+\.(gnss|nmea)", re.IGNORECASE)
_SERIAL_LINE = re.compile(r"(\d{1,3})\s+(\S{1,64})\s*")


@dataclass(frozen=True, slots=True)
class WalkPart:
    """One file of points, with what is beside it."""

    path: Path
    imu: Path | None
    """None = it is missing."""
    points: int
    t_first_ns: int
    """Of its first point with a time [ns]; 0 = none has one."""
    ids: tuple[int, ...]
    """Of the LiDARs at its head."""


@dataclass(frozen=True, slots=True)
class MandeyeWalk:
    """The parts of one walk, in the order of their times."""

    folder: Path
    parts: tuple[WalkPart, ...]
    serials: dict[int, str]
    """LiDAR -> its serial number, where it is stated."""
    status: DeviceStatus
    """What the device says of its LiDARs."""
    positions: tuple[Path, ...] = ()
    """Files of positions: one of each number, sentences only where nothing else is."""

    @property
    def ids(self) -> tuple[int, ...]:
        """Of all LiDARs."""
        return tuple(sorted({*self.serials, *(k for part in self.parts for k in part.ids)}))


def is_points_file(name: str) -> bool:
    """Whether a file has the points of a part, by its name."""
    return POINTS_NAME.fullmatch(name) is not None


def list_walk(folder: Path, report: ImportReport) -> MandeyeWalk:
    """The parts of a folder.

    Args:
        folder: The folder.
        report: Receives files that are damaged or missing, and those out of order.

    Raises:
        EmptyRecording: If no part has points.
        UnknownFormat: If there are several walks.
        RecordingError: If the folder cannot be read.
    """
    files = sorted((f for f in folder.iterdir() if is_points_file(f.name)), key=natural)
    parts = [part for file in files if (part := _part(file, report)) is not None]
    if not parts:
        raise EmptyRecording(CodedText("mandeye-no-points", folder=folder.name, count=len(files)))
    timed = [part for part in parts if part.t_first_ns]
    require_one_walk([FileTimes(p.path, p.t_first_ns, p.t_first_ns) for p in timed])
    # A part whose first points have no time is where its number says.
    places = np.maximum.accumulate([p.t_first_ns for p in parts])
    keys = {p.path: p.t_first_ns or int(at) for p, at in zip(parts, places, strict=True)}
    ordered = sorted(parts, key=lambda part: keys[part.path])
    moved = sum(a is not b for a, b in zip(parts, ordered, strict=True))
    report.count("files_out_of_order", moved)
    _note_missing(folder, ordered, report)
    serials = _serials(ordered, report)
    status = read_status((_status_path(part.path) for part in ordered), report)
    return MandeyeWalk(folder, tuple(ordered), serials, status, _positions(folder))


def _status_path(points: Path) -> Path:
    number = POINTS_NAME.fullmatch(points.name)
    assert number is not None
    return points.with_name(f"status{number[1]}.json")


def _part(path: Path, report: ImportReport) -> WalkPart | None:
    """A part; None (counted) if it is damaged or empty, as the last one after a power cut."""
    try:
        if not path.stat().st_size:
            raise CorruptFile(CodedText("file-empty", name=path.name))
        points = las_header(path).points
        head = next(las_points(path, most=MANDEYE.head_points), None) if points else None
        if head is None:
            raise CorruptFile(CodedText("file-no-points", file=path.name))
        times = times_ns(head)
        ids = tuple(distinct(np.asarray(head.user_data)).tolist())
    except (RecordingError, AttributeError) as error:
        report.count("files_corrupt")
        report.outcome = "lossy"
        report.warn(FindingKind.FILE_LEFT_OUT, error=error)
        return None
    number = POINTS_NAME.fullmatch(path.name)
    assert number is not None
    imu = path.with_name(f"imu{number[1]}.csv")
    first = times[times > 0]
    return WalkPart(
        path, imu if imu.is_file() else None, points, int(first.min()) if len(first) else 0, ids
    )


def times_ns(points: Any) -> Times:
    """Times of points of laspy [ns], (N,); 0 = none.

    Raises:
        AttributeError: If their format has no times.
    """
    seconds = np.asarray(points.gps_time, np.float64)
    sound = np.isfinite(seconds) & (seconds > 0.0) & (seconds < MANDEYE.latest_s)
    whole = np.floor(np.where(sound, seconds, 0.0))
    rest = np.where(sound, seconds, 0.0) - whole
    return whole.astype(np.int64) * 1_000_000_000 + np.rint(rest * 1e9).astype(np.int64)


def _note_missing(folder: Path, parts: Sequence[WalkPart], report: ImportReport) -> None:
    without = [part.path.name for part in parts if part.imu is None]
    report.count("imu_files_missing", len(without))
    if without and len(without) < len(parts):
        report.details["imu_files_missing"] = CodedText(
            "detail-of-files", names=", ".join(without[:5])
        )
        report.outcome = "lossy"


def _positions(folder: Path) -> tuple[Path, ...]:
    """Files of positions in their order: one of each number."""
    files = [file for file in folder.iterdir() if _POSITIONS.fullmatch(file.name)]
    lines_last = sorted(files, key=lambda file: file.suffix.lower() == ".gnss")
    chosen = {file.stem.lower(): file for file in lines_last}
    return tuple(sorted(chosen.values(), key=natural))


def _serials(parts: Iterable[WalkPart], report: ImportReport) -> dict[int, str]:
    found: dict[int, str] = {}
    for part in parts:
        path = part.path.with_suffix(".sn")
        if not path.is_file():
            continue
        try:
            lines = list(lines_limited(path, max_bytes=MANDEYE.most_bytes))
        except RecordingError as error:
            report.warn(FindingKind.SERIALS_UNREADABLE, error=error)
            continue
        for match in filter(None, map(_SERIAL_LINE.fullmatch, lines)):
            known = found.setdefault(int(match[1]), match[2])
            if known != match[2]:
                report.warn(
                    FindingKind.SERIALS_CHANGE,
                    name=path.name,
                    lidar=match[1],
                    serial=match[2],
                    before=known,
                )
    return {key: serial for key, serial in found.items() if key < 256}
