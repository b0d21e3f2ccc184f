"""Recordings of scans as the datagrams their sensors would have sent."""

from __future__ import annotations

import heapq
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from recon4.errors import UnknownFormat
from recon4.locales.coded import CodedText
from recon4.model.ports import PORTS
from recon4.model.rig import Rig
from recon4.recording.bags.messages import imu_row, stamp_ns
from recon4.recording.bags.topic_choice import choose_imu, named_imu
from recon4.recording.formats.bags import LASER_SCAN, Bag
from recon4.recording.kinds import BAGS, PLANAR, bag_paths, recognize
from recon4.recording.lasers.laser2d import is_laser2d, read_laser2d
from recon4.recording.lasers.line_recording import LineRecording
from recon4.recording.lasers.scan_datagrams import encode_head, encode_scan, encode_scans_row
from recon4.recording.lasers.scan_messages import usual_angles
from recon4.recording.report import ImportReport
from recon4.recording.rigs.profiler import profiler_rig
from recon4.recording.samples.csv_files import IMU_HEADER
from recon4.settings import IngestSettings


@dataclass(frozen=True, slots=True)
class ScanDatagram:
    """A datagram of a sensor."""

    t_ns: int
    """Time it is sent, on the clock of the recording [ns]."""
    port: int
    payload: bytes


def has_scans(recording: Path, rig: Rig | None) -> bool:
    """Whether a recording is of a 2-D laser or a profiler, in a file that is no capture.

    Raises:
        RecordingError: If it cannot be read.
    """
    try:
        kind = recognize(recording)
    except UnknownFormat:  # a folder with captures among other files
        return False
    if kind in PLANAR:
        return True
    return kind in BAGS and (is_laser2d(recording) or _line_rig(recording, rig) is not None)


def datagrams_of_scans(recording: Path, rig: Rig | None) -> Iterator[ScanDatagram]:
    """The datagrams of a recording in order of time.

    Args:
        recording: A bag, a CARMEN log or a table of a 2-D laser.
        rig: Topics and ports; None = the shipped rig whose topics the bag has, and default ports.

    Raises:
        RecordingError: If it cannot be read.
        ConfigError: If the angles of the profiler's head are missing.
    """
    is_bag = recognize(recording) in BAGS
    lines = _line_rig(recording, rig) if is_bag else None
    if lines is not None:
        return _of_lines(recording, lines)
    scans = _of_laser(recording, rig)
    if not is_bag or rig is None or not rig.imu_port:
        return scans
    return heapq.merge(scans, _of_imu(recording, rig), key=lambda sent: sent.t_ns)


def _line_rig(recording: Path, rig: Rig | None) -> Rig | None:
    """The rig of a bag with line scans; None = it has none."""
    with Bag(bag_paths(recording), ImportReport()) as bag:
        return profiler_rig(bag, rig, ImportReport())


def _of_laser(recording: Path, rig: Rig | None) -> Iterator[ScanDatagram]:
    row = None if rig is None else rig.row_of("laser2d")
    port = PORTS.laser2d if rig is None or row is None else rig.sensors[row].port
    scans = read_laser2d([recording], ImportReport())
    for k, t_ns in enumerate(scans.t_ns.tolist()):
        yield ScanDatagram(t_ns, port, encode_scans_row(scans, k))


def _of_imu(recording: Path, rig: Rig) -> Iterator[ScanDatagram]:
    with Bag(bag_paths(recording), ImportReport()) as bag:
        topic = choose_imu(bag, named_imu(rig, IngestSettings()), bag.report).topic
        for message in bag.messages({topic} - {""}):
            content = bag.decode(message)
            if content is not None:
                t_ns = stamp_ns(content.header.stamp)
                yield ScanDatagram(
                    message.t_ns, rig.imu_port, _imu_text(t_ns or message.t_ns, content)
                )


def _of_lines(recording: Path, rig: Rig) -> Iterator[ScanDatagram]:
    paths = bag_paths(recording)
    found = LineRecording(paths, rig, report=ImportReport())
    kinds = {topic.name: topic.type for topic in found.topics}
    if found.joint is not None:
        raise UnknownFormat(
            CodedText("replay-transforms", recording=recording.name, text=found.joint.text)
        )
    if kinds[found.lines_topic] != LASER_SCAN:
        raise UnknownFormat(
            CodedText(
                "replay-lines",
                recording=recording.name,
                laser_scan=LASER_SCAN,
                lines_topic=found.lines_topic,
                kinds=kinds[found.lines_topic],
            )
        )
    profiler, laser = rig.row_of("profiler"), rig.row_of("laser2d")
    assert profiler is not None
    ports = {found.lines_topic: rig.sensors[profiler].port}
    ports[found.head_topic] = rig.sensors[profiler].port
    ports[found.imu_topic] = rig.imu_port
    if laser is not None:
        ports[found.scans_topic] = rig.sensors[laser].port
    ports = {topic: port for topic, port in ports.items() if topic and port}
    with Bag(paths, ImportReport()) as bag:
        for message in bag.messages(ports):
            content = bag.decode(message)
            if content is None:
                continue
            t_ns = stamp_ns(content.header.stamp) or message.t_ns
            is_laser = message.topic == found.scans_topic
            payload = _payload(content, t_ns, is_laser=is_laser)
            if payload:
                yield ScanDatagram(message.t_ns, ports[message.topic], payload)


def _payload(content: Any, t_ns: int, *, is_laser: bool) -> bytes:
    """A message as a datagram; empty = it says nothing."""
    if hasattr(content, "ranges"):
        # With these angles the capture gives the same scans as the bag.
        return encode_scan(content, t_ns, angles=usual_angles(content) if is_laser else None)
    if hasattr(content, "position"):
        return encode_head(content.position[0], t_ns) if len(content.position) else b""
    return _imu_text(t_ns, content)


def _imu_text(t_ns: int, content: Any) -> bytes:
    values = dict(zip(IMU_HEADER[1:], imu_row(content), strict=True))
    finite = {name: value for name, value in values.items() if math.isfinite(value)}
    return json.dumps({IMU_HEADER[0]: t_ns, **finite}).encode()
