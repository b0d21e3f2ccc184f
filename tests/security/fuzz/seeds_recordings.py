"""Tiny valid recordings of every kind, built by code, and what reads each of them to its end.

`SEEDS` maps a kind to ``(build, read, suffix)``: ``build()`` gives the bytes of a valid file of at
most 80 kB, ``read(path)`` does with a path what ``recon4 info`` and the stage ``frames`` do up to
the last message.
"""

from __future__ import annotations

import io
import struct
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from recon4.recording.assembly.assembler import Assembler
from recon4.recording.assembly.shots import Shots
from recon4.recording.info.describe import describe
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import Bag, room_packets, storage_file, write_room_pcap

SECONDS = 0.03
"""Of LiDAR packets: 22 of them, less than one revolution."""
METADATA = "metadata.yaml"


@dataclass(frozen=True, slots=True)
class ReadResult:
    """What reading a recording to its end gave."""

    outcome: str
    """``complete``, ``lossy`` or ``nothing``, as in the import report."""
    counts: dict[str, int]
    findings: tuple[str, ...]
    items: int
    """Shots, samples and poses."""


def read_recording(path: Path) -> ReadResult:
    """Describe a recording, then read and assemble all of it.

    Raises:
        Recon4Error: If it is refused.
    """
    settings = IngestSettings()
    "\n".join(describe(path, settings=settings).lines())
    report = ImportReport()
    recording = open_recording(OpenRequest((path,), None, settings, report))
    assembler = Assembler(recording.rig, settings=settings, report=report, wait_s=recording.wait_s)
    items = 0
    for item in recording.read():
        items += len(item)
        if isinstance(item, Shots):
            for _ in assembler.push(item):
                pass
    for _ in assembler.flush():
        pass
    return ReadResult(report.outcome, dict(report.counts), tuple(report.said()), items)


read_pcap = read_pcapng = read_bag1 = read_db3 = read_mcap = read_recording
"""One entry serves every kind: the content of a file decides how it is read."""


def read_metadata(path: Path) -> ReadResult:
    """Read a rosbag2 folder whose ``metadata.yaml`` is the given file."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "bag"
        folder.mkdir()
        (folder / METADATA).write_bytes(path.read_bytes())
        (folder / "bag.db3").write_bytes(seed_db3())
        return read_recording(folder)


# -- capture files


def seed_pcap() -> bytes:
    """Classic pcap of one VLP-16."""
    with tempfile.TemporaryDirectory() as place:
        return write_room_pcap(Path(place) / "seed.pcap", seconds=SECONDS).read_bytes()


def seed_pcapng() -> bytes:
    """The same packets in pcapng with two interfaces (µs and ns) and an option block."""
    classic = seed_pcap()
    out = io.BytesIO()
    out.write(_block(0x0A0D0D0A, struct.pack("<IHHq", 0x1A2B3C4D, 1, 0, -1)))
    out.write(_block(1, struct.pack("<HHI", 1, 0, 262144)))
    nanoseconds = struct.pack("<HHB3xHH", 9, 1, 9, 0, 0)
    out.write(_block(1, struct.pack("<HHI", 1, 0, 262144) + nanoseconds))
    at, number = 24, 0
    while at < len(classic):
        seconds, nanos, captured, length = struct.unpack_from("<IIII", classic, at)
        packet = classic[at + 16 : at + 16 + captured]
        interface = number % 2
        ticks = (seconds * 1_000_000_000 + nanos) // (1 if interface else 1000)
        head = struct.pack("<IIIII", interface, ticks >> 32, ticks & 0xFFFF_FFFF, captured, length)
        out.write(_block(6, head + packet + bytes(-captured % 4)))
        at, number = at + 16 + captured, number + 1
    return out.getvalue()


def _block(kind: int, body: bytes) -> bytes:
    size = len(body) + 12
    return struct.pack("<II", kind, size) + body + struct.pack("<I", size)


# -- bags


def _fill(bag: Bag) -> None:
    t_ns, payloads = room_packets(seconds=SECONDS)
    for first in range(0, len(t_ns), 8):
        rows = slice(first, first + 8)
        start = int(t_ns[first])
        bag.scan("/velodyne_packets", t_ns[rows], payloads[rows])
        bag.odometry("/odom", start, float(first))
        for k in range(3):
            bag.imu("/imu", start + k * 1_000_000, (0.0, 0.0, 0.1), (0.0, 0.0, 9.8))
        bag.fix("/fix", start, 50.0, 14.0, 300.0)
    table = {name: np.arange(1.0, 40.0, dtype=np.float32) for name in "xyz"}
    bag.cloud("/points", int(t_ns[0]), table)


def _bag(kind: str, compression: str = "") -> bytes:
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / ("seed.bag" if kind == "bag1" else "seed")
        bag = Bag(path, kind)
        if kind == "bag1":
            bag.writer.chunk_threshold = 8192
        if compression:
            bag.writer.set_compression(bag.writer.CompressionFormat[compression.upper()])
        with bag:
            _fill(bag)
        return storage_file(path).read_bytes()


def seed_bag1() -> bytes:
    """rosbag1 of several plain chunks."""
    return _bag("bag1")


def seed_bag1_bz2() -> bytes:
    """rosbag1 of bz2 chunks."""
    return _bag("bag1", "bz2")


def seed_bag1_lz4() -> bytes:
    """rosbag1 of lz4 chunks."""
    return _bag("bag1", "lz4")


@cache
def seed_db3() -> bytes:
    """rosbag2 storage file in SQLite."""
    return _bag("db3")


def seed_metadata() -> bytes:
    """The ``metadata.yaml`` of `seed_db3`'s folder."""
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "bag"
        with Bag(path, "db3") as bag:
            _fill(bag)
        return (path / METADATA).read_bytes()


def seed_mcap() -> bytes:
    """MCAP of plain chunks."""
    return _mcap("NONE")


def seed_mcap_lz4() -> bytes:
    """MCAP of lz4 chunks."""
    return _mcap("LZ4")


def seed_mcap_zstd() -> bytes:
    """MCAP of zstd chunks."""
    return _mcap("ZSTD")


class _McapBag(Bag):
    """Writes MCAP with the reference writer: small chunks in every compression."""

    def __init__(self, path: Path, compression: str) -> None:
        from mcap.writer import CompressionType, Writer

        super().__init__(path / "unused", "db3")
        self.file = (path / "seed.mcap").open("wb")
        kind = CompressionType[compression]
        self.writer = Writer(self.file, chunk_size=8192, compression=kind)
        self.channels: dict[str, int] = {}

    def __enter__(self) -> _McapBag:
        self.writer.start("ros2", "recon4 tests")
        return self

    def __exit__(self, *_: object) -> None:
        self.writer.finish()
        self.file.close()

    def write(self, topic: str, kind: str, t_ns: int, message: object) -> None:
        if topic not in self.channels:
            schema = self.writer.register_schema(kind, "ros2msg", b"")
            self.channels[topic] = self.writer.register_channel(topic, "cdr", schema)
        data = bytes(self.store.serialize_cdr(message, kind))
        self.writer.add_message(self.channels[topic], t_ns, data, t_ns)


def _mcap(compression: str) -> bytes:
    with tempfile.TemporaryDirectory() as place:
        with _McapBag(Path(place), compression) as bag:
            _fill(bag)
        return (Path(place) / "seed.mcap").read_bytes()


SEEDS: dict[str, tuple[Callable[[], bytes], Callable[[Path], ReadResult], str]] = {
    "pcap": (seed_pcap, read_pcap, ".pcap"),
    "pcapng": (seed_pcapng, read_pcapng, ".pcapng"),
    "bag1": (seed_bag1, read_bag1, ".bag"),
    "bag1_bz2": (seed_bag1_bz2, read_bag1, ".bag"),
    "bag1_lz4": (seed_bag1_lz4, read_bag1, ".bag"),
    "db3": (seed_db3, read_db3, ".db3"),
    "mcap": (seed_mcap, read_mcap, ".mcap"),
    "mcap_lz4": (seed_mcap_lz4, read_mcap, ".mcap"),
    "mcap_zstd": (seed_mcap_zstd, read_mcap, ".mcap"),
    "metadata": (seed_metadata, read_metadata, ".yaml"),
}
"""Kind to: build, read, suffix of its files."""
