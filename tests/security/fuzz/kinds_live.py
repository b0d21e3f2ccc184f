"""What a live capture reads: packets and samples of the network, lines of its sockets, its files.

A capture file is read as by the mapper, while it grows; it must give what the finished file gives.
"""

from __future__ import annotations

import contextlib
import tempfile
from dataclasses import replace
from functools import cache, reduce
from operator import xor
from pathlib import Path
from typing import IO, cast

import numpy as np

from recon4.errors import Recon4Error
from recon4.live.mapper.gnss_watch import GnssWatch
from recon4.live.mapper.scan_map import ScanMap
from recon4.live.mapper.tail_file import TailFile, WriteProgress
from recon4.live.protocol import (
    AddMark,
    Fix,
    Mark,
    ProtocolError,
    Stop,
    Written,
    decode_message,
    decode_request,
    encode,
)
from recon4.live.session import CaptureSession, load_session
from recon4.model.laser_scans import LaserScans
from recon4.model.rig import load_rig
from recon4.recording.assembly.assembler import Assembler
from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.pcap import OpenFile, open_plain
from recon4.recording.lasers.range_units import LaserUnit
from recon4.recording.lasers.scan_datagrams import (
    HeadMessage,
    ScanMessage,
    decode_scan_datagram,
    encode_head,
    encode_scans_row,
)
from recon4.recording.lasers.scan_messages import ScanCollector, line_of_scan
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.packets.decoder import open_decoder
from recon4.recording.packets.family import PacketSensor
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.packets.velodyne.encode import encode_position, rmc_sentence
from recon4.recording.packets.velodyne.models import DATA_SIZE, POSITION_SIZE
from recon4.recording.packets.velodyne.position_packets import PositionDecoder
from recon4.recording.report import ImportReport
from recon4.recording.samples.datagrams import SampleDecoder
from recon4.settings import IngestSettings, Settings
from recon4_app.live.current_capture import marks_of
from tests.builders import T0_NS, room_packets
from tests.security.fuzz import seeds_recordings as recordings
from tests.security.fuzz import seeds_tables as tables
from tests.security.fuzz.kind import Kind, Reading


def _sentence(body: bytes) -> bytes:
    return b"$%s*%02X" % (body, reduce(xor, body))


PACKET_NS = 1_327_104
GROWS_BY = 5000
"""Bytes by which a capture file grows at a time, so that records are torn."""
GNSS_LINES = (
    rb'{"t_ns": 1700000000000000000, "lat_deg": 49.2, "lon_deg": 16.6, "height_m": 250.1,'
    rb' "sd_e_m": 0.02, "quality": 4}',
    rb'{"t_ns": 1700000000100000000, "gx_rad_s": 0.01, "gy_rad_s": 0.0, "gz_rad_s": -0.2,'
    rb' "ax_m_s2": 0.1, "ay_m_s2": 0.0, "az_m_s2": 9.8}',
    b"$GPGST,221320.00,0.1,0.2,0.1,5.0,0.02,0.03,0.05*69",
    _sentence(b"GPGGA,221321.00,4912.00000,N,01636.00000,E,4,12,0.8,250.1,M,45.0,M,1.0,0000"),
)


class _Growing(WriteProgress):
    """A file of which a little more is there each time somebody waits."""

    def __init__(self, size: int) -> None:
        super().__init__()
        self._size = size
        self.complete()

    def wait_beyond(self, offset: int) -> int:
        self.reached(min(self._size, offset + GROWS_BY))
        return super().wait_beyond(offset)


def _open_growing(path: Path) -> IO[bytes]:
    return cast("IO[bytes]", TailFile(path, _Growing(path.stat().st_size)))


def _read_all(path: Path, open_file: OpenFile) -> tuple[Reading, float]:
    """What a capture file gives, and the sum of its coordinates [m]."""
    settings, report = IngestSettings(), ImportReport()
    found = open_recording(OpenRequest((path,), None, settings, report, open_file=open_file))
    assembler = Assembler(found.rig, settings=settings, report=report, wait_s=found.wait_s)
    items, total = 0, 0.0
    for item in found.read():
        items += len(item)
        if isinstance(item, Shots):
            total += float(item.xyz.sum(dtype=np.float64))
            for _ in assembler.push(item):
                pass
    for _ in assembler.flush():
        pass
    return Reading(items, salvaged=report.outcome != "complete" or bool(report.findings)), total


def _capture(path: Path) -> Reading:
    """Read while it grows, then when it is finished: both must give the same."""
    growing = _outcome(path, _open_growing)
    finished = _outcome(path, open_plain)
    assert growing == finished, f"growing: {growing}, finished: {finished}"
    if isinstance(finished, str):
        raise ProtocolError(finished)
    return finished[0]


def _outcome(path: Path, open_file: OpenFile) -> tuple[Reading, float] | str:
    try:
        return _read_all(path, open_file)
    except Recon4Error as error:
        return str(error)


def _packets(path: Path) -> Reading:
    """Data packets of one sensor, one behind the other."""
    data = np.frombuffer(path.read_bytes(), dtype=np.uint8)
    count = len(data) // DATA_SIZE
    payloads = data[: count * DATA_SIZE].reshape(count, DATA_SIZE)
    report = ImportReport()
    decoder = open_decoder(
        PacketSensor(
            row=0, sensor=tables.rig().sensors[0], settings=IngestSettings(), report=report
        )
    )
    arrival = T0_NS + np.arange(count, dtype=np.int64) * PACKET_NS
    shots = [decoder.push(arrival[k : k + 7], payloads[k : k + 7]) for k in range(0, count, 7)]
    found = sum(map(len, (*shots, decoder.flush())))
    assert all(np.isfinite(part.xyz).all() for part in shots)
    return Reading(found, salvaged=_dropped(report) or len(data) % DATA_SIZE > 0)


def _positions(path: Path) -> Reading:
    """Position packets of one sensor, one behind the other."""
    data = np.frombuffer(path.read_bytes(), dtype=np.uint8)
    count = len(data) // POSITION_SIZE
    report, sensor = ImportReport(), tables.rig().sensors[0]
    clock = SensorClock(sensor.name, packet_s=PACKET_NS / 1e9, report=report)
    decoder = PositionDecoder(sensor, clock=clock, report=report)
    arrival = T0_NS + np.arange(count, dtype=np.int64) * 1_000_000_000
    found = decoder.push(arrival, data[: count * POSITION_SIZE].reshape(count, POSITION_SIZE))
    samples = [part for part in (found.imu, found.gnss) if part is not None]
    assert all((np.diff(part.t_ns) > 0).all() for part in samples)
    return Reading(
        sum(map(len, samples)), salvaged=_dropped(report) or len(data) % POSITION_SIZE > 0
    )


def _dropped(report: ImportReport) -> bool:
    """Whether something was counted as damaged."""
    signs = ("_wrong_", "_damaged", "_out_of_order", "_other_product", "_hdl64", "_duplicate")
    return any(
        count and any(sign in name for sign in signs) for name, count in report.counts.items()
    )


def _datagram(path: Path) -> Reading:
    """Samples in one datagram, with the message the page is sent of them."""
    report = ImportReport()
    imu, gnss = SampleDecoder(report).push([T0_NS], [path.read_bytes()])
    if gnss is not None:
        decode_message(encode(GnssWatch().push(gnss)))
        assert (np.abs(gnss.lat_rad) <= np.pi / 2).all(), "a latitude beyond the pole"
    found = sum(len(part) for part in (imu, gnss) if part is not None)
    return Reading(found, salvaged=_dropped(report))


def _scan_seeds() -> tuple[bytes, ...]:
    rng = np.random.default_rng(1)
    ranges = rng.uniform(0.5, 9.0, 40).astype(np.float32)
    scans = LaserScans.of_rows(
        np.array([T0_NS], np.int64),
        ranges[None],
        angles=(-1.0, 0.05),
        range_max_m=20.0,
        time_step_s=1e-4,
    )
    scans = replace(scans, odometry=np.array([[1.0, 2.0, 0.3]]))
    return encode_scans_row(scans, 0), encode_head(1.25, T0_NS)


def _scan(path: Path) -> Reading:
    """A datagram of a 2-D laser, after a sound one, as the live map and as a line of a profiler."""
    report, rig = ImportReport(), load_rig("wuerzburg")
    collector, found = ScanCollector(0, report), 0
    sound = decode_scan_datagram(_scan_seeds()[0])
    message = decode_scan_datagram(path.read_bytes())
    if not isinstance(message, ScanMessage) or not isinstance(sound, ScanMessage):
        return Reading(0, salvaged=not isinstance(message, HeadMessage))
    live = ScanMap(rig, Settings())
    for k, one in enumerate((sound, message)):
        for scans in (*collector.add(one, T0_NS + k, where="laser2d"), *collector.flush()):
            scans = LaserUnit(report).in_meters(scans)
            pose, _ = live.push(scans)
            assert np.isfinite([*pose.p, pose.yaw]).all()
            found += 1
    assert np.isfinite(line_of_scan(message, 1, T0_NS, report=report).xyz).all()
    return Reading(found, salvaged=found < 2)


def _lines(path: Path) -> Reading:
    """Lines of a socket, each as both sides read it."""
    read = [_is_line(line) for line in path.read_bytes().split(b"\n") if line.strip()]
    return Reading(sum(read), salvaged=not all(read))


def _is_line(line: bytes) -> bool:
    """Whether it is a request or a message."""
    found = 0
    for decode in (decode_request, decode_message):
        with contextlib.suppress(ProtocolError):
            found += bool(encode(decode(line)))
    return bool(found)


def _session(path: Path) -> Reading:
    session = load_session(path.parents[1])
    assert type(session.speed) in (int, float)
    assert type(session.least_free_bytes) is int
    assert type(session.preset) is type(session.address) is str
    return Reading(1)


def _marks(path: Path) -> Reading:
    lines = [line for line in path.read_bytes().splitlines() if line.strip()]
    found = len(marks_of(CaptureSession(project=path.parents[1])))
    return Reading(found, salvaged=found < len(lines))


@cache
def _packet_seeds() -> tuple[bytes, ...]:
    _, payloads = room_packets(seconds=recordings.SECONDS)
    return (payloads.tobytes(),)


@cache
def _position_seeds() -> tuple[bytes, ...]:
    times = [T0_NS + k * 1_000_000_000 for k in range(4)]
    sentences = [rmc_sentence(t_ns, lat_deg=49.2, lon_deg=16.6) for t_ns in times]
    packets = [
        encode_position(t_ns // 1000, text) for t_ns, text in zip(times, sentences, strict=True)
    ]
    for k, packet in enumerate(packets):
        packet[14:38] = np.arange(24, dtype=np.uint8) + k
    return (b"".join(packet.tobytes() for packet in packets),)


def _datagram_seeds() -> tuple[bytes, ...]:
    return b"\n".join(GNSS_LINES), *GNSS_LINES


def _line_seeds() -> tuple[bytes, ...]:
    lines = [Stop(), AddMark(what="point", text="stairs", who="anna", ago_s=1.5)]
    messages = [
        Written(size=5000),
        Mark(t_ns=T0_NS, what="point", text="stairs"),
        Fix(t_ns=T0_NS, quality=4, lat_rad=0.8, lon_rad=0.2, sd_m=[0.1, 0.1, 0.2], jumped_m=None),
    ]
    return (b"".join(encode(line) for line in (*lines, *messages)),)


@cache
def _session_seeds() -> tuple[bytes, ...]:
    with tempfile.TemporaryDirectory() as place:
        CaptureSession(project=Path(place)).save()
        return ((Path(place) / "live" / "session.json").read_bytes(),)


def _mark_seeds() -> tuple[bytes, ...]:
    first = b'{"t_ns": 1700000000000000000, "what": "point", "text": "stairs", "who": "anna"}\n'
    return (first + b'{"t_ns": 1700000001000000000, "what": "pause"}\n',)


def _folder(name: str, folder: Path) -> None:
    (folder / name).mkdir(exist_ok=True)


KINDS = (
    Kind(
        name="live-capture",
        file_name="a.pcap",
        seeds=lambda: (recordings.seed_pcap(), recordings.seed_pcapng()),
        read=_capture,
        knows_end=False,
    ),
    Kind(name="live-packets", file_name="a", seeds=_packet_seeds, read=_packets, knows_end=False),
    Kind(
        name="live-positions",
        file_name="a",
        seeds=_position_seeds,
        read=_positions,
        knows_end=False,
    ),
    Kind(
        name="live-samples", file_name="a", seeds=_datagram_seeds, read=_datagram, knows_end=False
    ),
    Kind(name="live-scans", file_name="a", seeds=_scan_seeds, read=_scan, knows_end=False),
    Kind(name="live-lines", file_name="a", seeds=_line_seeds, read=_lines, knows_end=False),
    Kind(
        name="live-session",
        file_name="live/session.json",
        seeds=_session_seeds,
        read=_session,
        prepare=lambda folder: _folder("live", folder),
    ),
    Kind(
        name="live-marks",
        file_name="recordings/marks.jsonl",
        seeds=_mark_seeds,
        read=_marks,
        prepare=lambda folder: _folder("recordings", folder),
        knows_end=False,
    ),
)
