"""Messages ``sensor_msgs/LaserScan``: as line scans of a profiler, as scans of a 2-D laser."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.model.laser_scans import LaserScans
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.bags import BagMessage
from recon4.recording.report import ImportReport

_SCANS_AT_ONCE = 250
_MAX_BEAMS = 100_000
_MAX_LINE_S = 10.0
"""A line or scan of longer duration has wrong times."""
_LONGEST_M = 1e4
_MAX_ANGLE_RAD = 100.0
"""Angles of more than some turns are wrong [rad]; degrees are rejected with them."""


def line_of_scan(scan: Any, row: int, t_ns: int, *, report: ImportReport) -> Shots:
    """The returns of a line: in the x-z plane of the head, angles from x towards z.

    Args:
        scan: The message.
        row: Of the profiler in the rig.
        t_ns: Time of the first shot [ns].
        report: Receives what was derived.

    Raises:
        CorruptFile: If its angles or times are no numbers, or it has too many shots.
    """
    ranges, step_rad, step_s = _checked(scan)
    if step_s == 0.0:
        report.derive("line scans without times of their shots: all shots at the stamp")
    seen = _returns(scan, ranges)
    number = np.flatnonzero(seen)
    angle = float(scan.angle_min) + step_rad * number
    r = ranges[seen].astype(np.float64)
    xyz = np.stack([r * np.cos(angle), np.zeros(len(r)), r * np.sin(angle)], axis=1)
    intensities = np.asarray(scan.intensities, np.float32)
    if len(intensities) == len(ranges):
        intensity = np.clip(np.nan_to_num(intensities[seen]), 0, 65535).astype(np.uint16)
    else:
        report.derive("line scans without intensities: 0 is stored")
        intensity = np.zeros(len(r), np.uint16)
    none = np.zeros(len(r), np.uint8)
    times = t_ns + np.rint(1e9 * step_s * number).astype(np.int64)
    return Shots(row, times, xyz.astype(np.float32), intensity, none, none)


class ScanCollector:
    """Collects the scans of a 2-D laser; those of another layout are counted and left out."""

    def __init__(self, offset_ns: int, report: ImportReport, *, exact_angles: bool = False) -> None:
        """Prepare.

        Args:
            offset_ns: Added to all times.
            report: Receives counts.
            exact_angles: Take the angles as they are; those of a bag are float32, so only the
                digits of `usual_angles` mean something.
        """
        self._offset_ns, self._report = offset_ns, report
        self._exact = exact_angles
        self._layout: tuple[int, float, float] | None = None
        self._angles = (0.0, 0.0)
        """First angle and step [rad]."""
        self._rest = (0.0, 0.0)
        """Largest range [m] and time between two beams [s]."""
        self._ranges: list[NDArray[np.float32]] = []
        self._t_ns: list[int] = []
        self._odometry: list[Sequence[float] | None] = []
        self._last_ns = -1

    def push(self, message: BagMessage, scan: Any) -> Iterator[LaserScans]:
        """Add a message; returns scans in batches."""
        stamp = scan.header.stamp
        t_ns = int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)
        yield from self.add(scan, t_ns if t_ns > 0 else message.t_ns, where=message.topic)

    def add(
        self, scan: Any, t_ns: int, *, where: str, odometry: Sequence[float] | None = None
    ) -> Iterator[LaserScans]:
        """Add a scan with the fields of a ``LaserScan``; returns scans in batches.

        Args:
            scan: Ranges and angles.
            t_ns: Time of its first beam [ns].
            where: What remarks name.
            odometry: Pose of the laser by the recording: x [m], y [m], yaw [rad].
        """
        t_ns += self._offset_ns
        try:
            ranges, step_rad, step_s = _checked(scan)
        except CorruptFile as error:
            self._report.count("messages_corrupt")
            self._report.warn(f"{where}: left out: {error}")
            return
        if t_ns <= self._last_ns:
            again = t_ns == self._last_ns
            self._report.count("scans_duplicate" if again else "scans_out_of_order")
            return
        layout = (len(ranges), *usual_angles(scan))
        if self._layout is None:
            self._layout = layout
            self._angles = (float(scan.angle_min), step_rad) if self._exact else layout[1:]
            self._rest = (float(scan.range_max), step_s)
        elif layout != self._layout:
            self._report.count("scans_of_another_layout")
            self._report.warn(
                f"{where}: scans of another layout are left out: expected beams, first "
                f"angle and step {self._layout}, got {layout}"
            )
            return
        self._last_ns = t_ns
        self._t_ns.append(t_ns)
        self._odometry.append(odometry)
        seen = _returns(scan, ranges)
        self._report.count("scans_without_returns", int(not seen.any()))
        self._ranges.append(np.where(seen, ranges, np.float32(np.nan)))
        self._report.count("scans")
        if len(self._t_ns) >= _SCANS_AT_ONCE:
            yield from self.flush()

    def flush(self) -> Iterator[LaserScans]:
        """The remaining scans."""
        if self._layout is None or not self._t_ns:
            return
        t_ns, ranges = np.array(self._t_ns, np.int64), np.stack(self._ranges)
        known = [pose for pose in self._odometry if pose is not None]
        odometry = np.array(known, np.float64) if len(known) == len(t_ns) else None
        self._t_ns, self._ranges, self._odometry = [], [], []
        yield LaserScans(
            t_ns=t_ns,
            range_m=ranges,
            angle_min_rad=self._angles[0],
            angle_step_rad=self._angles[1],
            range_max_m=self._rest[0],
            time_step_s=self._rest[1],
            odometry=odometry,
        )


def usual_angles(scan: Any) -> tuple[float, float]:
    """First angle and step of a ``LaserScan`` [rad], with the digits that float32 has."""
    return round(float(scan.angle_min), 6), round(float(scan.angle_increment), 9)


def _checked(scan: Any) -> tuple[NDArray[np.float32], float, float]:
    """Ranges, angle between two shots [rad] and time between them [s]."""
    ranges = np.asarray(scan.ranges, np.float32)
    numbers = [scan.angle_min, scan.angle_increment, scan.time_increment, scan.scan_time]
    if not np.all(np.isfinite(numbers)) or not len(ranges) or scan.angle_increment == 0.0:
        raise CorruptFile(
            f"a scan: expected ranges, and angles and times that are numbers, got {len(ranges)} "
            f"ranges and {[float(n) for n in numbers]}"
        )
    if len(ranges) > _MAX_BEAMS:
        raise CorruptFile(f"a scan: expected at most {_MAX_BEAMS} shots, got {len(ranges)}")
    widest = max(abs(float(scan.angle_min)), abs(float(scan.angle_increment)) * len(ranges))
    if widest > _MAX_ANGLE_RAD:
        raise CorruptFile(
            f"a scan: expected angles within {_MAX_ANGLE_RAD:g} rad, got {widest:.3g} rad"
        )
    step_s = float(scan.time_increment)
    if not 0.0 <= step_s * len(ranges) <= _MAX_LINE_S:
        raise CorruptFile(
            f"a scan: expected 0 to {_MAX_LINE_S:g} s from first to last shot, got "
            f"{step_s * len(ranges):.3g} s"
        )
    return ranges, float(scan.angle_increment), step_s


def _returns(scan: Any, ranges: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Shots that returned: within the sensor's limits (REP 117)."""
    low = max(float(scan.range_min), 1e-3) if np.isfinite(scan.range_min) else 1e-3
    high = float(scan.range_max) if scan.range_max > low else _LONGEST_M
    with np.errstate(invalid="ignore"):
        return np.asarray((ranges >= low) & (ranges <= min(high, _LONGEST_M)), dtype=np.bool_)
