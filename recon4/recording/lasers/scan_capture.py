"""Capture files with datagrams of a 2-D laser or a profiler (`scan_datagrams`)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError, CorruptFile, EmptyRecording
from recon4.geometry.se3 import SE3
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.laser_scans import LaserScans, joined_scans
from recon4.model.rig import Rig, Sensor
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.recording.clocks.compare import LIDAR
from recon4.recording.formats.datagrams import Datagrams, address_number, address_text
from recon4.recording.formats.pcap import OpenFile, open_plain
from recon4.recording.lasers.head_angles import HeadAngles
from recon4.recording.lasers.line_recording import LineAssembly, LineItem
from recon4.recording.lasers.range_units import LaserUnit
from recon4.recording.lasers.scan_datagrams import (
    HeadMessage,
    ScanMessage,
    decode_scan_datagram,
    is_scan_datagram,
)
from recon4.recording.lasers.scan_messages import ScanCollector, line_of_scan
from recon4.recording.lasers.tuning import SCAN_DATAGRAMS
from recon4.recording.packets.datagram_files import read_datagrams
from recon4.recording.packets.slots import in_slots
from recon4.recording.packets.streams import by_sender, recognized
from recon4.recording.report import ImportReport
from recon4.recording.samples.datagrams import SampleDecoder
from recon4.recording.tuning import PROBE


@dataclass(frozen=True, slots=True)
class ScanStreams:
    """Datagrams of scans at the head of a capture file."""

    scans: Counter[tuple[str, int]]
    """Sender and port -> datagrams with ranges."""
    heads: Counter[tuple[str, int]]
    """Sender and port -> angles of a head."""
    has_lidar: bool
    """Whether there are data packets of a LiDAR too."""

    @property
    def laser(self) -> tuple[str, int] | None:
        """Sender and port of a 2-D laser: most scans and no head; None = there is none."""
        of_profilers = {port for _, port in self.heads}
        lasers = {key: n for key, n in self.scans.items() if key[1] not in of_profilers}
        return max(lasers, key=lambda key: lasers[key]) if lasers else None


def scan_streams(files: Sequence[Path]) -> ScanStreams:
    """Find the datagrams of scans at the head of capture files.

    Raises:
        RecordingError: If a file cannot be read.
    """
    scans: Counter[tuple[str, int]] = Counter()
    heads: Counter[tuple[str, int]] = Counter()
    for file in files:
        left = PROBE.scan_datagrams
        for batch in islice(read_datagrams(file, ImportReport()), PROBE.scan_batches):
            rows = np.arange(min(len(batch), left))
            others = []
            for row in rows.tolist():
                payload = batch.payload(row)
                if not is_scan_datagram(payload):
                    others.append(row)
                    continue
                key = address_text(int(batch.source[row])), int(batch.port[row])
                if b'"ranges"' in payload:
                    scans[key] += 1
                else:
                    heads[key] += 1
            if _has_lidar(batch.take(np.array(others, dtype=np.intp))):
                return ScanStreams(scans, heads, has_lidar=True)
            left -= len(rows)
            if left <= 0:
                break
    return ScanStreams(scans, heads, has_lidar=False)


def _has_lidar(datagrams: Datagrams) -> bool:
    """Whether any sender sends data packets of a LiDAR to a port."""
    found = map(recognized, by_sender(datagrams))
    return any(one is not None and one.kind == "data" for one in found)


def is_scan_capture(files: Sequence[Path]) -> bool:
    """Whether capture files are of a 2-D laser without any LiDAR or profiler.

    Raises:
        RecordingError: If a file cannot be read.
    """
    found = scan_streams(files)
    return found.laser is not None and not found.heads and not found.has_lidar


def rig_of_scans(files: Sequence[Path], report: ImportReport) -> Rig:
    """A rig with the 2-D laser that sends the most datagrams, mounted at the origin.

    Raises:
        EmptyRecording: If none sends.
    """
    found = scan_streams(files).laser
    if found is None:
        raise EmptyRecording(CodedText("laser-no-datagrams", files=files[0].name))
    address, port = found
    report.derive(DerivedKind.LASER_BY_SENDER, address=address, port=port)
    laser = Sensor(
        name="laser2d",
        model="generic",
        T_body_sensor=SE3.identity(),
        kind="laser2d",
        address=address,
        port=port,
    )
    return Rig(
        name="found in the recording",
        sensors=(laser,),
        T_body_imu=SE3.identity(),
        imu_time_offset_s=0.0,
        p_body_antenna=np.zeros(3),
        gnss_time_offset_s=0.0,
    )


class ScanCapture:
    """Streams the scans of a rig with a 2-D laser, and the lines of its profiler if it has one.

    Datagrams are read in slots of the recorder's clock, so that a file that grows gives the same
    as a finished one.
    """

    def __init__(
        self,
        files: Sequence[Path],
        rig: Rig,
        *,
        report: ImportReport,
        open_file: OpenFile = open_plain,
    ) -> None:
        """Prepare; nothing is read yet.

        Raises:
            ConfigError: If 2-D laser and profiler cannot be distinguished.
        """
        self._files, self._report, self._open = files, report, open_file
        self.rig = rig
        laser, profiler = (_sensor(rig, kind) for kind in ("laser2d", "profiler"))
        if laser and profiler and _same_source(laser[1], profiler[1]):
            raise ConfigError(
                CodedText(
                    "laser-port-shared",
                    rig=rig.name,
                    laser=laser[1].name,
                    profiler=profiler[1].name,
                    port=laser[1].port,
                )
            )
        self._laser = _LaserReader(laser[1], report) if laser else None
        self._profiler = _ProfilerReader(profiler[0], rig, report) if profiler else None
        self._samples = SampleDecoder(report)

    def read(self) -> Iterator[LineItem | GnssSamples]:
        """Stream all files once: samples first, then lines, then scans of each slot."""
        for file in self._files:
            for slot in in_slots(read_datagrams(file, self._report, self._open)):
                yield from self._decode_samples(slot)
                if self._profiler:
                    yield from self._profiler.push(slot)
                if self._laser:
                    yield from self._laser.push(slot)
        if self._profiler:
            yield from self._profiler.flush()
        if self._laser:
            self._laser.finish()

    def _decode_samples(self, slot: Datagrams) -> Iterator[ImuSamples | GnssSamples]:
        ports = [port for port in (self.rig.imu_port, self.rig.gnss_port) if port]
        rows = np.flatnonzero(np.isin(slot.port, ports)).tolist()
        texts = [slot.payload(row) for row in rows]
        for samples in self._samples.push(slot.t_ns[rows].tolist(), texts):
            if samples is not None:
                yield samples


class _StampedMessages:
    """The messages of one sensor with times that do not jump."""

    def __init__(self, sensor: Sensor, report: ImportReport) -> None:
        self._sensor, self._report = sensor, report
        self._shift_ns = 0
        self._last: tuple[int, int] | None = None
        """Time of the last message and of its arrival [ns]."""

    def of(self, slot: Datagrams) -> Iterator[tuple[int, ScanMessage | HeadMessage]]:
        """Messages of the sensor in a slot with their times [ns]; damaged ones are counted."""
        for row in np.flatnonzero(self._mine(slot)).tolist():
            message = decode_scan_datagram(slot.payload(row))
            if message is None:
                self._report.count("scans_damaged")
                continue
            yield self._steady(message.t_ns, int(slot.t_ns[row])), message

    def _mine(self, slot: Datagrams) -> NDArray[np.bool_]:
        mine = slot.port == self._sensor.port
        if self._sensor.address:
            mine &= slot.source == address_number(self._sensor.address)
        return np.asarray(mine, dtype=np.bool_)

    def _steady(self, stamp_ns: int | None, arrival_ns: int) -> int:
        """The time of a message; after a jump of the sensor's clock it follows the arrival."""
        t_ns = arrival_ns if stamp_ns is None else stamp_ns
        if self._last is not None:
            step_ns = t_ns + self._shift_ns - self._last[0]
            expected_ns = arrival_ns - self._last[1]
            off_ns = step_ns - expected_ns
            recorder_jumped = 0 < step_ns < SCAN_DATAGRAMS.jump_ns
            if abs(off_ns) > SCAN_DATAGRAMS.jump_ns and not recorder_jumped:
                self._shift_ns -= off_ns
                self._report.count_jump(self._sensor.name)
                self._report.warn(
                    FindingKind.CLOCK_JUMP,
                    sensor=self._sensor.name,
                    whose="sensor",
                    jump_s=off_ns / 1e9,
                    times="by-arrival",
                )
        t_ns += self._shift_ns
        self._last = t_ns, arrival_ns
        self._report.note_lag(LIDAR, arrival_ns - t_ns)
        if abs(t_ns - arrival_ns) > SCAN_DATAGRAMS.other_clock_ns:
            self._report.ahead_ns[self._sensor.name] = t_ns - arrival_ns
        else:
            self._report.ahead_ns.pop(self._sensor.name, None)
        return t_ns


class _LaserReader:
    """The scans of a 2-D laser."""

    def __init__(self, sensor: Sensor, report: ImportReport) -> None:
        self._name, self._report = sensor.name, report
        self._messages = _StampedMessages(sensor, report)
        offset_ns = round(1e9 * sensor.time_offset_s)
        self._scans = ScanCollector(offset_ns, report, exact_angles=True)
        self._unit = LaserUnit(report)

    def push(self, slot: Datagrams) -> Iterator[LaserScans]:
        for t_ns, message in self._messages.of(slot):
            if isinstance(message, HeadMessage):
                self._report.count("scans_damaged")
                continue
            yield from self._scans.add(message, t_ns, where=self._name, odometry=message.odometry)
        yield from map(self._unit.in_meters, self._scans.flush())

    def finish(self) -> None:
        """Say what was left out."""
        left_out = self._report.counts["scans_out_of_order"]
        if left_out:
            self._report.warn(FindingKind.SCANS_LATE, where=self._name, scans=left_out)


class _ProfilerReader:
    """The lines of a profiler and the angles of its head."""

    def __init__(self, row: int, rig: Rig, report: ImportReport) -> None:
        sensor = rig.sensors[row]
        self._row, self._report = row, report
        self._offset_ns = round(1e9 * sensor.time_offset_s)
        self._messages = _StampedMessages(sensor, report)
        self._head = HeadAngles(sensor.name, sensor.head_rate_rad_s, report)
        self._lines = LineAssembly(row, rig, self._head, report=report)
        self._name = sensor.name
        self._span_ns: tuple[int, int] | None = None

    def push(self, slot: Datagrams) -> Iterator[LineItem]:
        for t_ns, message in self._messages.of(slot):
            if isinstance(message, HeadMessage):
                self._head.push(t_ns + self._offset_ns, message.head_rad)
                continue
            first_ns = t_ns if self._span_ns is None else self._span_ns[0]
            self._span_ns = first_ns, t_ns
            yield from self._push_line(message, t_ns + self._offset_ns)
        yield from self._lines.deliver()

    def _push_line(self, message: ScanMessage, t_ns: int) -> Iterator[LineItem]:
        try:
            shots = line_of_scan(message, self._row, t_ns, report=self._report)
        except CorruptFile as error:
            self._report.count("messages_corrupt")
            self._report.warn(FindingKind.MESSAGE_LEFT_OUT, where=self._name, error=error)
            return
        yield from self._lines.push_shots(shots)

    def flush(self) -> Iterator[LineItem]:
        """The remaining lines; judges the head over the whole walk.

        Raises:
            RecordingError: If the head stood still all the time.
        """
        yield from self._lines.flush()
        if self._span_ns is not None:
            self._head.finish((self._span_ns[1] - self._span_ns[0]) / 1e9)


def read_scan_captures(files: Sequence[Path], report: ImportReport) -> LaserScans:
    """All scans of a 2-D laser in capture files.

    Raises:
        RecordingError: If they cannot be read or have no scan.
    """
    rig = rig_of_scans(files, report)
    capture = ScanCapture(files, rig, report=report)
    parts = [item for item in capture.read() if isinstance(item, LaserScans)]
    if not parts:
        raise EmptyRecording(CodedText("laser-no-scan-read", files=files[0].name))
    scans = joined_scans(parts)
    if scans.odometry is None:
        report.derive(DerivedKind.ODOMETRY_MISSING)
    return scans


def _sensor(rig: Rig, kind: str) -> tuple[int, Sensor] | None:
    """Row and sensor of the first enabled one of a kind."""
    found = ((k, s) for k, s in enumerate(rig.sensors) if s.kind == kind and s.enabled)
    return next(found, None)


def _same_source(a: Sensor, b: Sensor) -> bool:
    return a.port == b.port and (a.address == b.address or "" in (a.address, b.address))
