"""Messages ``sensor_msgs/LaserScan``: as line scans of a profiler, as scans of a 2-D laser."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.laser_scans import LaserScans
from recon4.recording.assembly.shots import Shots
from recon4.recording.clocks.set_back import say_set_back
from recon4.recording.clocks.stamp_order import StampOrder
from recon4.recording.clocks.stamps import StampClock
from recon4.recording.formats.bags import BagMessage
from recon4.recording.lasers.tuning import SCAN_BEAMS
from recon4.recording.limits import LIMITS
from recon4.recording.report import ImportReport


def line_of_scan(scan: Any, row: int, t_ns: int, *, report: ImportReport, across: int = 2) -> Shots:
    """The returns of a line: angles from x towards the second axis of the plane of the head.

    Args:
        scan: The message.
        row: Of the profiler in the rig.
        t_ns: Time of the first shot [ns].
        report: Receives what was derived.
        across: The second axis, see `recon4.recording.lasers.head_angles.Head`.

    Raises:
        CorruptFile: If its angles are no numbers, or it has no or too many shots.
    """
    ranges, step_rad, step_s = _checked(scan, report)
    if step_s == 0.0:
        report.derive(DerivedKind.LINES_UNTIMED)
    seen = _returns(scan, ranges)
    number = np.flatnonzero(seen)
    angle = float(scan.angle_min) + step_rad * number
    r = ranges[seen].astype(np.float64)
    xyz = np.zeros((len(r), 3))
    xyz[:, 0], xyz[:, across] = r * np.cos(angle), r * np.sin(angle)
    intensities = np.asarray(scan.intensities, np.float32)
    if len(intensities) == len(ranges):
        intensity = np.clip(np.nan_to_num(intensities[seen]), 0, 65535).astype(np.uint16)
    else:
        report.derive(DerivedKind.INTENSITY_MISSING, line_scans=True)
        intensity = np.zeros(len(r), np.uint16)
    none = np.zeros(len(r), np.uint8)
    times = t_ns + np.rint(1e9 * step_s * number).astype(np.int64)
    return Shots(row, times, xyz.astype(np.float32), intensity, none, none)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Collected:
    """One scan; the fields are those of `LaserScans`."""

    t_ns: int
    ranges: NDArray[np.float32]
    angles: tuple[float, float]
    """First angle and step [rad]."""
    range_max_m: float
    time_step_s: float
    odometry: Sequence[float] | None


class ScanCollector:
    """Collects the scans of a 2-D laser, each with the beams and angles it states."""

    def __init__(
        self,
        offset_ns: int,
        report: ImportReport,
        *,
        exact_angles: bool = False,
        stamps: StampClock | None = None,
    ) -> None:
        """Prepare.

        Args:
            offset_ns: Added to all times.
            report: Receives counts.
            exact_angles: Take the angles as they are; those of a bag are float32, so only the
                digits of `usual_angles` mean something.
            stamps: Of the topic of a bag.
        """
        self._stamps = stamps or StampClock()
        self._offset_ns, self._report = offset_ns, report
        self._exact = exact_angles
        self._order: StampOrder[tuple[str, Any]] = StampOrder()
        self._topic = ""
        self._scans: list[_Collected] = []
        self._last_ns = -1
        self._last_ranges = np.zeros(0, np.float32)

    def push(self, message: BagMessage, scan: Any) -> Iterator[LaserScans]:
        """Add a message, in the order of recording; returns scans in batches."""
        stamp = scan.header.stamp
        t_ns = int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)
        if not self._stamps.is_sound(t_ns, message.t_ns):
            self._report.count("scans_wrong_time")
            t_ns = self._stamps.expected_ns(message.t_ns)
        else:
            self._order.shift_last(self._stamps.set_before, -self._stamps.set_ns)
            t_ns += self._stamps.shift_ns
        self._topic = message.topic
        for stamp_ns, (topic, one) in self._order.push(t_ns, (message.topic, scan)):
            yield from self.add(one, stamp_ns, where=topic)

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
            ranges, step_rad, step_s = _checked(scan, self._report)
        except CorruptFile as error:
            self._report.count("scans_damaged")
            if self._report.counts["scans_damaged"] == 1:
                self._report.warn(FindingKind.SCAN_LEFT_OUT, where=where, alone=True, error=error)
            return
        if t_ns <= self._last_ns:
            self._report.count(self._reason(t_ns, ranges))
            return
        self._last_ns, self._last_ranges = t_ns, ranges
        seen = _returns(scan, ranges)
        angles = (float(scan.angle_min), step_rad) if self._exact else usual_angles(scan)
        self._scans.append(
            _Collected(
                t_ns=t_ns,
                ranges=np.where(seen, ranges, np.float32(np.nan)),
                angles=angles,
                range_max_m=float(scan.range_max),
                time_step_s=step_s,
                odometry=odometry,
            )
        )
        self._report.count("scans_without_returns", int(not seen.any()))
        self._report.count("scans")
        if len(self._scans) >= SCAN_BEAMS.scans_at_once:
            yield from self.deliver()

    def _reason(self, t_ns: int, ranges: NDArray[np.float32]) -> str:
        """Why a scan that is not later than the last one is left out."""
        if t_ns < self._last_ns:
            return "scans_out_of_order"
        repeated = np.array_equal(ranges, self._last_ranges, equal_nan=True)
        return "scans_repeated" if repeated else "scans_duplicate"

    def flush(self) -> Iterator[LaserScans]:
        """The remaining scans, at the end."""
        for stamp_ns, (topic, scan) in self._order.flush():
            yield from self.add(scan, stamp_ns, where=topic)
        say_set_back(self._topic, self._order.steps, self._report)
        self._report.count("scans_out_of_order", self._order.too_late)
        yield from self.deliver()

    def deliver(self) -> Iterator[LaserScans]:
        """The scans added so far."""
        scans, self._scans = self._scans, []
        if not scans:
            return
        known = [scan.odometry for scan in scans if scan.odometry is not None]
        angles = np.array([scan.angles for scan in scans], np.float64)
        yield LaserScans(
            t_ns=np.array([scan.t_ns for scan in scans], np.int64),
            range_m=np.concatenate([scan.ranges for scan in scans]),
            start=np.cumsum([0] + [len(scan.ranges) for scan in scans]),
            angle_min_rad=angles[:, 0],
            angle_step_rad=angles[:, 1],
            time_step_s=np.array([scan.time_step_s for scan in scans], np.float64),
            range_max_m=max(scan.range_max_m for scan in scans),
            odometry=np.array(known, np.float64) if len(known) == len(scans) else None,
        )


def usual_angles(scan: Any) -> tuple[float, float]:
    """First angle and step of a ``LaserScan`` [rad], with the digits that float32 has."""
    return round(float(scan.angle_min), 6), round(float(scan.angle_increment), 9)


def _checked(scan: Any, report: ImportReport) -> tuple[NDArray[np.float32], float, float]:
    """Ranges, angle between two shots [rad] and time between them [s]; 0 = not known."""
    ranges = np.asarray(scan.ranges, np.float32)
    if not 0 < len(ranges) <= LIMITS.beams:
        raise CorruptFile(CodedText("scan-ranges", beams=LIMITS.beams, count=len(ranges)))
    first, step = float(scan.angle_min), float(scan.angle_increment)
    wide = abs(step) * (len(ranges) - 1) >= SCAN_BEAMS.narrowest_rad or len(ranges) == 1
    if not np.all(np.isfinite([first, step])) or step == 0.0 or not wide:
        raise CorruptFile(CodedText("scan-angles", first=first, step=step))
    widest = max(abs(first), abs(step) * len(ranges))
    if widest > SCAN_BEAMS.max_angle_rad:
        raise CorruptFile(
            CodedText("scan-angles-wide", max_angle_rad=SCAN_BEAMS.max_angle_rad, widest=widest)
        )
    # Messages of datagrams have no last angle.
    last = float(getattr(scan, "angle_max", np.nan))
    if abs(last - first - step * (len(ranges) - 1)) > SCAN_BEAMS.angle_max_steps * abs(step):
        report.count("scans_of_another_last_angle")
    step_s = float(scan.time_increment)
    if not 0.0 <= step_s * len(ranges) <= SCAN_BEAMS.max_line_s:
        report.count("scans_of_wrong_beam_times")
        step_s = 0.0
    return ranges, step, step_s


def _returns(scan: Any, ranges: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Shots that returned: within the sensor's limits (REP 117)."""
    low = max(float(scan.range_min), 1e-3) if np.isfinite(scan.range_min) else 1e-3
    longest_m = SCAN_BEAMS.longest_m
    high = float(scan.range_max) if scan.range_max > low else longest_m
    measured = ranges[np.isfinite(ranges) & (ranges > low)]
    if len(measured) and np.median(measured) > SCAN_BEAMS.other_unit * high:
        high = longest_m  # the ranges are of another unit than their limit: see `range_units`
    with np.errstate(invalid="ignore"):
        return np.asarray((ranges >= low) & (ranges <= min(high, longest_m)), dtype=np.bool_)
