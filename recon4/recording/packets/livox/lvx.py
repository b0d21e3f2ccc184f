"""Files of Livox Viewer, LVX 1.0, 1.1 and LVX2, as the datagrams that they were made of.

Sources: LVX Specifications v1.1 (2019-09-24) and LVX2 Specifications v1.0 (2023); LVX 1.0 as in
Livox's ROS driver. A file is a list of devices and frames of some 50 ms; a frame is a list of
packages, each a packet of one device. Packages of LVX 1 are whole packets of SDK1; those of LVX2
lack the interval of SDK2, which follows from the model.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, EmptyRecording, UnknownFormat
from recon4.geometry.se3 import SE3
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.formats.datagrams import MAX_UDP_BYTES, Datagrams
from recon4.recording.formats.pcap import OpenFile, open_plain
from recon4.recording.limits import LIMITS
from recon4.recording.packets.livox.models import (
    IMU_SAMPLE,
    LAYOUTS,
    LVX1_TYPE_AT,
    SDK1_HEADER,
    SDK1_IMU_SIZE,
    SDK1_IMU_TYPE,
    SDK1_PORT,
    SDK2_HEADER,
    SDK2_IMU_TYPE,
    SDK2_PORT,
)
from recon4.recording.packets.livox.sound import stamps_ns
from recon4.recording.packets.livox.tuning import LVX
from recon4.recording.report import ImportReport

MAGIC = b"livox_tech"
_PUBLIC = struct.Struct("<16s4BI")
_DEVICE1 = struct.Struct("<16s16sBBB6f")
_DEVICE1_0 = struct.Struct("<16s16sBB6f")
_DEVICE2 = struct.Struct("<16s16sIBBB6f")
_FRAME = struct.Struct("<QQQ")
_PACKAGE2 = struct.Struct("<BIBB8sHBIB4x")
"""Version, device, kind of LiDAR, time type, stamp, counter, data type, bytes, frame."""
_PACKET2 = struct.Struct("<BHHHHBBB12xI8s")
"""`SDK2_HEADER`."""
_SIZES1 = {layout.data_type: layout.size for layout in LAYOUTS if layout.sdk == 1}
_SIZES1[SDK1_IMU_TYPE] = SDK1_IMU_SIZE
"""Data type -> bytes of a packet of SDK1."""
_POINT_BYTES = {layout.data_type: layout.record.itemsize for layout in LAYOUTS if layout.sdk == 2}
_POINT_BYTES[SDK2_IMU_TYPE] = IMU_SAMPLE.itemsize
"""Data type -> bytes of a point, or of a sample, of SDK2."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LvxDevice:
    """One LiDAR of a file."""

    key: int
    """What its packages are marked with."""
    address: int
    """Of its datagrams: a number that stands for it."""
    serial: str
    mount: SE3 | None
    """T_body_sensor, if the file says that it was used; None = not stated."""


@dataclass(frozen=True, slots=True)
class LvxHead:
    """What is in front of the frames."""

    version: tuple[int, int]
    devices: tuple[LvxDevice, ...]
    data_start: int
    """Offset of the first frame."""

    @property
    def sdk(self) -> int:
        """Protocol of the packets."""
        return 2 if self.version[0] == 2 else 1


def is_lvx(path: Path) -> bool:
    """Whether the first bytes are those of an LVX file."""
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


def read_lvx_head(path: Path, open_file: OpenFile = open_plain) -> LvxHead:
    """The devices of a file.

    Raises:
        UnknownFormat: If it is no LVX file, or one of another version.
        CorruptFile: If it ends inside of the list of devices.
    """
    with open_file(path) as file:
        return _read_head(file, path.name)


def read_lvx(
    path: Path, report: ImportReport, open_file: OpenFile = open_plain
) -> Iterator[Datagrams]:
    """Stream the packets of a file, a batch for each frame.

    Their time of arrival is that of their stamps; devices whose clocks differ are moved to the
    clock of the first one by the order of the packages. Counts ``records``; a file that ends inside
    a frame yields what is before (``files_cut``), and ``report.outcome`` becomes ``lossy``.

    Raises:
        UnknownFormat, CorruptFile: As `read_lvx_head`.
        EmptyRecording: If no frame has a packet.
    """
    found = 0
    with open_file(path) as file:
        head = _read_head(file, path.name)
        arrival = _Arrival()
        for body in _frames(file, head, path.name, report=report):
            datagrams = _datagrams(body, head, arrival, report=report)
            report.count("records", len(datagrams))
            found += len(datagrams)
            if len(datagrams):
                yield datagrams
    if not found:
        raise EmptyRecording(CodedText("lvx-no-packet", file=path.name))


def _read_head(file: IO[bytes], name: str) -> LvxHead:
    raw = file.read(_PUBLIC.size)
    if not raw.startswith(MAGIC) or len(raw) < _PUBLIC.size:
        raise UnknownFormat(CodedText("lvx-magic", name=name, magic=MAGIC.decode()))
    _, major, minor, *_ = _PUBLIC.unpack(raw)
    if (major, minor) not in ((1, 0), (1, 1), (2, 0)):
        raise UnknownFormat(CodedText("lvx-version", name=name, major=str(major), minor=str(minor)))
    private = file.read(1 if (major, minor) == (1, 0) else 5)
    layout = {(1, 0): _DEVICE1_0, (1, 1): _DEVICE1, (2, 0): _DEVICE2}[major, minor]
    count = private[-1] if private else 0
    rows = file.read(count * layout.size)
    if not count or len(rows) < count * layout.size:
        raise CorruptFile(CodedText("lvx-devices-cut", name=name, count=count))
    devices = tuple(
        _device(layout.unpack_from(rows, k * layout.size), k, (major, minor)) for k in range(count)
    )
    start = _PUBLIC.size + len(private) + len(rows)
    return LvxHead((major, minor), devices, start)


def _device(row: tuple[Any, ...], place: int, version: tuple[int, int]) -> LvxDevice:
    serial, _, key, *rest = row
    has_flag = version != (1, 0)
    values = np.array(rest[-6:], np.float64)
    used = bool(rest[-7]) if has_flag else bool(np.any(values))
    roll, pitch, yaw = np.deg2rad(values[:3])
    sound = bool(np.isfinite(values).all() and np.abs(values[3:]).max() < 100.0)
    return LvxDevice(
        key=int(key),
        address=place + 1,
        serial=bytes(serial).split(b"\0")[0].decode("ascii", "replace"),
        mount=SE3.from_rpy(roll, pitch, yaw, t=values[3:]) if used and sound else None,
    )


def _frames(file: IO[bytes], head: LvxHead, name: str, *, report: ImportReport) -> Iterator[bytes]:
    """The packages of each frame."""
    extra = 8 if head.version == (1, 0) else 0  # the number of packages
    at = head.data_start
    while raw := file.read(_FRAME.size + extra):
        if len(raw) < _FRAME.size + extra:
            _cut(name, report)
            return
        here, after, _ = _FRAME.unpack_from(raw)
        size = after - here - len(raw)
        if here != at or not 0 <= size <= LIMITS.lvx_frame_bytes:
            report.count("files_cut")
            report.outcome = "lossy"
            report.warn(FindingKind.FRAME_LENGTH, name=name, at=at, begin=here, end=after)
            return
        body = file.read(size)
        if len(body) < size:
            _cut(name, report)
        yield body
        at = after


def _cut(name: str, report: ImportReport) -> None:
    report.count("files_cut")
    report.outcome = "lossy"
    report.warn(FindingKind.FILE_SALVAGED, name=name)


def _datagrams(body: bytes, head: LvxHead, arrival: _Arrival, *, report: ImportReport) -> Datagrams:
    """The packets of a frame."""
    rows = list(_packages1(body, report) if head.sdk == 1 else _packages2(body, report))
    addresses = {device.key: device.address for device in reversed(head.devices)}
    known = [row for row in rows if row[0] in addresses]
    report.count("records_of_unknown_device", len(rows) - len(known))
    source = np.array([addresses[key] for key, _ in known], np.uint32)
    length = np.array([len(packet) for _, packet in known], np.int64)
    size = (SDK1_HEADER if head.sdk == 1 else SDK2_HEADER).itemsize
    headers = np.frombuffer(b"".join(packet[:size] for _, packet in known), np.uint8)
    return Datagrams(
        arrival.of(source, stamps_ns(headers.reshape(-1, size), head.sdk)),
        source,
        np.full(len(known), SDK1_PORT if head.sdk == 1 else SDK2_PORT, np.uint16),
        length,
        np.cumsum(length) - length,
        np.frombuffer(b"".join([packet for _, packet in known]), np.uint8),
    )


def _packages1(body: bytes, report: ImportReport) -> Iterator[tuple[int, bytes]]:
    """Device and packet of each package of LVX 1: the packet follows the number of the device."""
    at, header = 0, 1 + SDK1_HEADER.itemsize
    while at + header <= len(body):
        size = _SIZES1.get(body[at + LVX1_TYPE_AT], 0)
        if not size:
            report.count("records_damaged")
            return
        if at + 1 + size > len(body):
            return
        yield body[at], body[at + 1 : at + 1 + size]
        at += 1 + size


def _packages2(body: bytes, report: ImportReport) -> Iterator[tuple[int, bytes]]:
    """Device and packet of each package of LVX2."""
    at = 0
    while at + _PACKAGE2.size <= len(body):
        version, device, _, time_type, stamp, counter, data_type, size, frame = (
            _PACKAGE2.unpack_from(body, at)
        )
        of_one = _POINT_BYTES.get(data_type, 0)
        if not of_one or size > MAX_UDP_BYTES:
            report.count("records_damaged")
            return
        at += _PACKAGE2.size
        if at + size > len(body):
            return
        length = _PACKET2.size + size
        fields = version, length, 0, size // of_one, counter, frame, data_type, time_type, 0, stamp
        yield device, _PACKET2.pack(*fields) + body[at : at + size]
        at += size


class _Arrival:
    """Times of arrival of the packets of all devices on one clock.

    A file has none, but its packages are in the order of arrival. So a packet came when its stamp
    says, unless that is far from the others of its frame; and devices whose clocks differ are moved
    to that of the first one, by the frame in which both are.
    """

    def __init__(self) -> None:
        self._offset_ns: dict[int, int] = {}
        """Device -> clock of arrival minus its clock."""
        self._last_ns: int | None = None

    def of(self, device: NDArray[np.uint32], stamps_ns: Times) -> Times:
        """When the packets of a frame came [ns], (N,)."""
        arrived = np.zeros(len(device), np.int64)
        latest = self._last_ns
        for one in dict.fromkeys(device.tolist()):
            rows = np.flatnonzero(device == one)
            stamps = stamps_ns[rows]
            usual = int(np.sort(stamps)[len(stamps) // 2])
            offset = self._offset(one, usual)
            near = np.abs(stamps - usual) < LVX.same_clock_ns
            arrived[rows] = np.where(near, stamps, usual) + offset
            latest = max(latest or 0, usual + offset)
        self._last_ns = latest
        return arrived

    def _offset(self, device: int, stamp_ns: int) -> int:
        if self._last_ns is None:
            self._last_ns = stamp_ns
        offset = self._offset_ns.get(device, 0)
        if not -LVX.same_clock_ns < stamp_ns + offset - self._last_ns < LVX.longest_pause_ns:
            offset = self._last_ns - stamp_ns
        self._offset_ns[device] = offset
        return offset
