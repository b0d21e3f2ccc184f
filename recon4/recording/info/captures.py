"""Contents of capture files, for ``recon4 info``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from recon4.locales.coded import CodedText
from recon4.locales.texts import Shown
from recon4.recording.formats.pcap import open_plain
from recon4.recording.frame_files.copies import without_copies
from recon4.recording.info.records import RecordingInfo, SensorInfo
from recon4.recording.kinds import capture_files
from recon4.recording.lasers.scan_capture import ScanStreams, scan_streams
from recon4.recording.packets.capture import sensors_of
from recon4.recording.packets.family import Companion
from recon4.recording.packets.streams import PacketStream, require_one_capture, scan_pcap
from recon4.recording.report import ImportReport
from recon4.recording.tuning import LISTED, PROBE

SCAN_CAPTURE = CodedText("recording-scans")
_SAMPLES = {"samples": "samples", "IMU": "imu", "GNSS": "gnss"}
"""Kind of a stream -> word of what it sends."""


def describe_capture(
    info: RecordingInfo, path: Path, companions: Sequence[Companion]
) -> RecordingInfo:
    """Sensors, samples and unread streams of capture files.

    Raises:
        RecordingError: If they cannot be read.
    """
    files = without_copies(capture_files(path), ImportReport())
    require_one_capture(files)
    most = PROBE.whole_packets if info.bytes <= PROBE.whole_bytes else PROBE.head_packets
    scans = [scan_pcap(file, max_packets=most, companions=companions) for file in files]
    streams = [stream for scan in scans for stream in scan]
    scanners = scan_streams(files)
    lidars = [_packet_sensor(group) for group in sensors_of(streams, open_plain)]
    lidars += [_scanner(s, scanners) for s in streams if (s.source, s.port) in scanners.scans]
    return replace(
        info,
        kind=SCAN_CAPTURE if scanners.scans else info.kind,
        t_first_ns=min((s.t_first_ns for s in streams), default=0),
        t_last_ns=max((s.t_end_ns for s in streams), default=0),
        estimated=not all(s.whole for s in streams),
        sensors=tuple(lidars),
        samples=tuple(_samples(s) for s in streams if s.kind in _SAMPLES),
        unread=tuple(_unread(s) for s in _others(streams, scanners)),
    )


def _samples(stream: PacketStream) -> CodedText:
    sender, what = f"{stream.source}:{stream.port}", _SAMPLES[stream.kind]
    return CodedText("samples-sender", sender=sender, count=_total(stream), what=what)


def _unread(stream: PacketStream) -> CodedText:
    of: dict[str, Shown] = {"packets": stream.packets, "source": stream.source}
    return CodedText("unread-packets", **of, port=stream.port, why=stream.refused or "")


def _others(streams: Sequence[PacketStream], scanners: ScanStreams) -> list[PacketStream]:
    """The largest streams that are not read."""
    scans = {*scanners.scans, *scanners.heads}
    others = [s for s in streams if s.refused and (s.source, s.port) not in scans]
    return sorted(others, key=lambda s: -s.packets)[: LISTED.streams]


def _total(stream: PacketStream) -> int:
    """Estimated packets in the file, from the rate at its head."""
    head_s = (stream.t_last_ns - stream.t_first_ns) / 1e9
    all_s = (stream.t_end_ns - stream.t_first_ns) / 1e9
    return stream.packets if stream.whole or head_s <= 0 else round(stream.packets * all_s / head_s)


def _packet_sensor(streams: Sequence[PacketStream]) -> SensorInfo:
    """A LiDAR, whose packets are in one file or in several."""
    stream = streams[0]
    span_s = (stream.t_last_ns - stream.t_first_ns) / 1e9
    mode = {"mode": stream.found.mode} if stream.found and stream.found.mode else {}
    return SensorInfo(
        label=f"{stream.source}:{stream.port}",
        model=stream.model or "unknown model",
        content=CodedText("content-packets-mode" if mode else "content-packets", **mode),
        count=sum(map(_total, streams)),
        rate_hz=(stream.packets - 1) / span_s if span_s > 0 else float("nan"),
        rotation_hz=stream.found.rotation_hz if stream.found else float("nan"),
        findings=stream.findings,
    )


def _scanner(stream: PacketStream, found: ScanStreams) -> SensorInfo:
    """A sender of scans; one that also sends angles of a head is a profiler."""
    key = stream.source, stream.port
    ratio = found.scans[key] / (found.scans[key] + found.heads[key])
    span_s = (stream.t_last_ns - stream.t_first_ns) / 1e9
    return SensorInfo(
        label=f"{stream.source}:{stream.port}",
        model="profiler" if found.heads[key] else "2-D laser",
        content=CodedText("content-line-scans" if found.heads[key] else "content-scans"),
        count=round(ratio * _total(stream)),
        rate_hz=ratio * (stream.packets - 1) / span_s if span_s > 0 else float("nan"),
    )
