"""CARMEN logs: scans of a 2-D laser with the odometry of a robot, one message a line.

    FLASER n r1 … rn x y theta odom_x odom_y odom_theta ipc_time host logger_time
    ROBOTLASER1 type start fov step max accuracy mode n r1 … rn m i1 … im
        laser_x laser_y laser_theta robot_x robot_y robot_theta tv rv … time host logger_time
    RAWLASER1 type start fov step max accuracy mode n r1 … rn m i1 … im time host logger_time

RLASER, ROBOTLASER2 and RAWLASER2 are the same of a laser at the back of the robot.
Angles count counter-clockwise, ranges and positions are in meters.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, EmptyRecording
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import FindingKind
from recon4.recording.formats.text_logs import first_lines, log_lines
from recon4.recording.report import ImportReport

FRONT = (b"FLASER", b"ROBOTLASER1", b"RAWLASER1")
"""Messages that are read; of several kinds in one log the one with the most scans is used."""
REAR = (b"RLASER", b"ROBOTLASER2", b"RAWLASER2")
"""Those of a second laser, which are read in a log without the others."""
MESSAGES = (*FRONT, *REAR)
_OTHERS = frozenset(b"PARAM SYNC ODOM TRUEPOS NMEA-GGA IMU MESSAGE BUMPER".split())
_PROBED_LINES = 200
_MAX_BEAMS = 20_000
_MAX_SCANS = 5_000_000
_MAX_VALUES = 400_000_000
"""Ranges of all scans together, 1.6 GB."""
_FIELDS_OF_VIEW_DEG = {541: 270.0, 1081: 270.0, 682: 239.766, 683: 240.117, 726: 255.234}
"""Beams of common lasers with other fields of view than 180°, which `FLASER` does not state."""
_LATEST_S = 9e9
_TAIL = 9
"""Values behind the ranges of a `FLASER` message."""


@dataclass(frozen=True, slots=True, eq=False)
class CarmenScans:
    """Scans of one laser as they are in the log, in the order of its lines."""

    message: str
    t_ns: NDArray[np.int64]
    """Times of measurement [ns], (N,); not sorted."""
    range_m: NDArray[np.float32]
    """Ranges of all scans as written, one after the other, (R,)."""
    start: NDArray[np.int64]
    """Row of the first range of each scan, and the number of ranges, (N + 1,)."""
    laser: Array | None
    """Poses of the laser: x [m], y [m], yaw [rad], (N, 3); None = the message has none."""
    robot: Array | None
    """Poses of the robot, (N, 3)."""
    angle_min_rad: Array
    """Direction of the first beam of each scan [rad], (N,)."""
    angle_step_rad: Array
    """Angle between two beams of each scan [rad], (N,)."""
    range_max_m: Array
    """Stated largest range of each scan [m], (N,); 0 = not stated."""

    def ranges(self, k: int) -> NDArray[np.float32]:
        """Ranges of scan ``k`` as written, (M,)."""
        return self.range_m[self.start[k] : self.start[k + 1]]


@dataclass(frozen=True, slots=True)
class _StatedBeams:
    """What a message says of its beams."""

    start_rad: float
    step_rad: float
    max_m: float


@dataclass(slots=True)
class _Line:
    """One scan."""

    message: bytes
    t_ns: int
    beams: _StatedBeams
    ranges: NDArray[np.float32]
    laser: tuple[float, ...]
    robot: tuple[float, ...]


def is_carmen(path: Path) -> bool:
    """Whether a file begins as a CARMEN log, plain or compressed."""
    words = [line.split(maxsplit=1) for line in first_lines(path, _PROBED_LINES)]
    names = [line[0] for line in words if line and not line[0].startswith(b"#")]
    known = sum(name in MESSAGES or name in _OTHERS for name in names)
    return known > 0 and known >= 0.8 * len(names)


def read_carmen(path: Path, report: ImportReport) -> CarmenScans:
    """Read the scans of a log.

    Args:
        path: The log, plain, ``.bz2`` or ``.gz``.
        report: Receives what is damaged and left out.

    Raises:
        EmptyRecording: If it has no scan.
        CorruptFile: If it cannot be read.
    """
    lines: list[_Line] = []
    values = 0
    for line in _scan_lines(path, report):
        lines.append(line)
        values += len(line.ranges)
        if len(lines) > _MAX_SCANS or values > _MAX_VALUES:
            raise CorruptFile(
                CodedText(
                    "carmen-many", file=path.name, max_scans=_MAX_SCANS, max_values=_MAX_VALUES
                )
            )
    if not lines:
        raise EmptyRecording(
            CodedText(
                "carmen-none",
                file=path.name,
                messages=", ".join(name.decode() for name in MESSAGES),
            )
        )
    return _collected(_of_one_message(_of_one_laser(lines, report), path.name, report))


def _of_one_laser(lines: list[_Line], report: ImportReport) -> list[_Line]:
    """The scans of the front laser; without one those of the rear laser."""
    front = [line for line in lines if line.message in FRONT]
    if not front:
        return lines
    if len(front) < len(lines):
        report.count("scans_of_the_rear_laser", len(lines) - len(front))
    return front


def _of_one_message(lines: list[_Line], name: str, report: ImportReport) -> list[_Line]:
    """The scans of the most frequent message; loggers write one scan as several messages."""
    message, most = Counter(line.message for line in lines).most_common(1)[0]
    used = [line for line in lines if line.message == message]
    others = np.array([line.t_ns for line in lines if line.message != message], np.int64)
    if most == len(lines):
        return used
    t_ns = np.sort(np.array([line.t_ns for line in used], np.int64))
    period_ns = np.median(np.diff(t_ns)) if most > 1 else 0
    after = np.searchsorted(t_ns, others)
    nearest = [t_ns[np.clip(row, 0, most - 1)] for row in (after - 1, after)]
    apart_ns = np.abs(np.array(nearest) - others).min(axis=0)
    repeated = int(np.count_nonzero(apart_ns <= period_ns))
    report.count("scans_repeated", repeated)
    report.count("scans_of_another_message", len(others) - repeated)
    if repeated < len(others):
        report.warn(
            FindingKind.SCANS_OF_OTHERS,
            name=name,
            left_out=len(others) - repeated,
            scans=len(lines),
            message=message.decode(),
            read=most,
        )
    return used


def _collected(lines: list[_Line]) -> CarmenScans:
    has_poses = bool(lines[0].laser)
    return CarmenScans(
        message=lines[0].message.decode(),
        t_ns=np.array([line.t_ns for line in lines], np.int64),
        range_m=np.concatenate([line.ranges for line in lines]),
        start=np.cumsum([0] + [len(line.ranges) for line in lines]),
        laser=np.array([line.laser for line in lines]) if has_poses else None,
        robot=np.array([line.robot for line in lines]) if has_poses else None,
        angle_min_rad=np.array([line.beams.start_rad for line in lines]),
        angle_step_rad=np.array([line.beams.step_rad for line in lines]),
        range_max_m=np.array([line.beams.max_m for line in lines]),
    )


def _scan_lines(path: Path, report: ImportReport) -> Iterator[_Line]:
    for number, text in enumerate(log_lines(path, report), start=1):
        name, _, rest = text.partition(b" ")
        if name not in MESSAGES:
            continue
        try:
            has_header = name not in (b"FLASER", b"RLASER")
            yield _laser1(name, rest) if has_header else _flaser(name, rest)
        except (ValueError, IndexError, OverflowError) as error:
            report.count("scans_damaged")
            report.outcome = "lossy"
            if report.counts["scans_damaged"] == 1:
                report.warn(FindingKind.SCAN_LEFT_OUT, where=path.name, line=number, error=error)


def _flaser(name: bytes, text: bytes) -> _Line:
    words = text.split()
    beams = _count(words[0])
    if len(words) < 1 + beams + _TAIL:
        raise ValueError(f"expected {1 + beams + _TAIL} values, got {len(words)}")
    ranges = _numbers(words[1 : 1 + beams], np.float32)
    poses = _poses(words[1 + beams : 7 + beams])
    fov_deg = _FIELDS_OF_VIEW_DEG.get(beams, 180.0)
    # 180 beams of 1 degree begin at -90 and end at 89; 181 end at 90.
    steps = beams if beams % 2 == 0 and fov_deg == 180.0 else beams - 1
    step = float(np.deg2rad(fov_deg / max(steps, 1)))
    angles = _StatedBeams(float(-np.deg2rad(fov_deg) / 2.0), step, 0.0)
    return _Line(name, _time_ns(words[7 + beams]), angles, ranges, poses[:3], poses[3:])


def _laser1(name: bytes, text: bytes) -> _Line:
    words = text.split()
    start, _, step, max_m = (_number(word) for word in words[1:5])
    beams = _count(words[7])
    ranges = _numbers(words[8 : 8 + beams], np.float32)
    if len(ranges) != beams:
        raise ValueError(f"expected {beams} ranges, got {len(ranges)}")
    behind = words[9 + beams + int(words[8 + beams]) :]
    if step == 0.0:
        raise ValueError("expected an angle between beams, got 0")
    poses = _poses(behind[:6]) if name.startswith(b"ROBOTLASER") else ()
    angles = _StatedBeams(start, step, max_m)
    return _Line(name, _time_ns(behind[-3]), angles, ranges, poses[:3], poses[3:])


def _count(word: bytes) -> int:
    count = int(word)
    if not 1 <= count <= _MAX_BEAMS:
        raise ValueError(f"expected 1 to {_MAX_BEAMS} beams, got {count}")
    return count


def _numbers(words: list[bytes], dtype: type[np.float32]) -> NDArray[np.float32]:
    return np.array(words, dtype=dtype)


def _number(word: bytes) -> float:
    value = float(word)
    if not np.isfinite(value):
        raise ValueError(f"expected a number, got {word[:20]!r}")
    return value


def _poses(words: list[bytes]) -> tuple[float, ...]:
    if len(words) != 6:
        raise ValueError(f"expected two poses, got {len(words)} values")
    return tuple(_number(word) for word in words)


def _time_ns(word: bytes) -> int:
    seconds, _, fraction = word.partition(b".")
    if not 0.0 <= float(word) < _LATEST_S:
        raise ValueError(f"expected a time in seconds, got {word[:20]!r}")
    if fraction and not fraction.isdigit():
        return round(float(word) * 1e9)
    # Nine digits behind the point do not fit into a float.
    return int(seconds) * 1_000_000_000 + int((fraction + b"000000000")[:9])
