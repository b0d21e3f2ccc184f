"""Where the fields of a Hesai data packet lie: read from its own header.

Packets begin with ``ee ff``, the version of the protocol, and a header that tells how many channels
and blocks follow and which optional parts there are; the Pandar40P has no header at all. Sources:
the chapters "Point Cloud Data Packet" of the user manuals PandarXT-32 (X01-en-230710), XT32M2X
(X02), PandarQT (Q01-en-2101A1), QT128C2X (Q03), Pandar40P (402), Pandar64 (640), Pandar128E3X
(128-en-210810), AT128E2X (A01-en-230920), JT16 and JT128, and Hesai's published SDK 2.0.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntFlag
from functools import cache

import numpy as np
from numpy.typing import NDArray

HEADER = 12
"""Bytes of the header; two packets of one sensor have the same."""
START = b"\xee\xff"
PANDAR40P_SIZES = (1262, 1266)
"""Bytes of its packets without and with a sequence number."""
PANDAR40P_BLOCK = b"\xff\xee"
"""Start of each block of a Pandar40P."""
JT16_SIZE = 80
JT16_IMU_SIZE = 34
CRC_POLYNOMIAL = 0x04C11DB7
"""CRC-32/MPEG-2."""
ECHO_AT = 8
"""Byte of the header that changes with the return mode; behind it the unit of the distance."""
RETURNED_AT = 10
"""Byte of the header with the number of returns."""
FIRST_OT128, FIRST_JT128 = 128, 137
"""Versions of the status of protocol 1.4 from which on the packets are of these."""


class Flag(IntFlag):
    """Last byte of the header: optional parts of the packet."""

    SEQUENCE = 0x01
    IMU = 0x02
    SAFETY = 0x04
    SIGNATURE = 0x08
    CONFIDENCE = 0x10
    WEIGHT = 0x20
    LIGHT = 0x40


@dataclass(frozen=True, slots=True, kw_only=True)
class PacketTail:
    """Offsets of fields after the start of the tail; -1 = the tail has no such field."""

    size: int
    mode: int
    """Return mode."""
    speed: int
    """Revolutions a minute, u2; a tenth of them for the JT128."""
    date: int
    """Year, month, day, hour, minute, second, or a zero and seconds since 1970."""
    micros: int
    """Microseconds of the second, u4."""
    state: int = -1
    """Operational state."""
    azimuth_flag: int = -1
    """Firing sequence of each block, two bits each, u2."""
    sequence: int = -1
    """Firing sequence of the packet (QT128)."""


_PANDAR = PacketTail(size=22, mode=14, speed=8, date=16, micros=10)
_XT = PacketTail(size=24, mode=10, speed=11, date=13, micros=19)
_QT = PacketTail(size=24, mode=16, speed=10, date=18, micros=12)
_QT128 = PacketTail(size=26, mode=12, speed=13, date=15, micros=21, sequence=5)
_PANDAR128 = PacketTail(size=26, mode=12, speed=13, date=15, micros=21, state=11, azimuth_flag=9)
_AT128 = PacketTail(size=32, mode=24, speed=18, date=26, micros=20)
_JT16 = PacketTail(size=66, mode=-1, speed=-1, date=0, micros=6)
"""The time stands in front of the block."""


@dataclass(frozen=True, slots=True, kw_only=True)
class HesaiLayout:
    """Offsets in a data packet [bytes]."""

    size: int
    channels: int
    blocks: int
    blocks_at: int
    block_bytes: int
    azimuth_at: int
    """Azimuth in a block: u2 [0.01°]; for the AT128 a byte more, [0.01° / 256]."""
    returns_at: int
    """First return in a block."""
    return_bytes: int
    """From one return to the next: distance u2, reflectivity u1, then what the flags say."""
    unit_mm: int
    """Unit of the distance [mm]."""
    tail_at: int
    tail: PacketTail
    imu_at: int = -1
    """Inertial sample behind the tail; -1 = none."""
    crc_at: int = -1
    """Checksum of the tail (of the whole packet for the JT16); -1 = none."""

    @property
    def crc_from(self) -> int:
        """Where the bytes start that `crc_at` sums."""
        return 0 if self.tail is _JT16 else self.tail_at


class _Bytes:
    """Sizes of optional parts of a packet [bytes]."""

    CRC = 4
    SAFETY = 17
    SIGNATURE = 32
    SEQUENCE = 4
    IMU = 22


@dataclass(frozen=True, slots=True)
class _Protocol:
    """What is alike in the packets of one version."""

    tail: PacketTail
    header: int = HEADER
    fine_azimuth: bool = False
    return_bytes: int = 0
    """0 = as the flags say."""
    sums: bool = False
    """Whether body and tail end in a checksum."""


_PROTOCOLS = {
    (1, 4): _Protocol(_PANDAR128, sums=True),
    (3, 1): _Protocol(_QT, return_bytes=4),
    (3, 2): _Protocol(_QT128, sums=True),
    (4, 1): _Protocol(_AT128, fine_azimuth=True, return_bytes=4, sums=True),
    (4, 3): _Protocol(_AT128, fine_azimuth=True, return_bytes=4, sums=True),
    (6, 1): _Protocol(_XT, return_bytes=4),
}
UNREAD = {
    (1, 4): "a Pandar or OT of 40, 64 or 90 channels",
    **dict.fromkeys([(2, 4), (2, 5), (2, 6), (2, 7)], "an ET25 or ET30"),
    (4, 7): "an ATX",
    (7, 2): "an FT120",
}
"""Versions of protocols whose packets are of no model of the table, or of none but the usual."""
_PANDAR64 = _Protocol(_PANDAR, header=8, return_bytes=3)
_PANDAR64_SIZES = (1194, 1198)
_MAX_SHOTS = 1024
"""More returns do not fit into a datagram of Ethernet."""


def read_layout(payload: NDArray[np.uint8]) -> HesaiLayout | None:
    """HesaiLayout of a data packet; None = no data packet of a Hesai.

    Args:
        payload: One UDP payload, (size,).
    """
    return _layout(len(payload), payload[:HEADER].tobytes())


@cache
def _layout(size: int, head: bytes) -> HesaiLayout | None:
    if size in PANDAR40P_SIZES and head[:2] == PANDAR40P_BLOCK:
        return _pandar40p(size)
    if len(head) < HEADER or head[:2] != START:
        return None
    if size in _PANDAR64_SIZES and head[2:4] == bytes((64, 6)):
        return _with_header(size, _PANDAR64, head[2:8])
    if head[2:4] == bytes((1, 8)):
        return _jt16() if size == JT16_SIZE and head[5] == 0 else None
    protocol = _PROTOCOLS.get((head[2], head[3]))
    return _with_header(size, protocol, head[6:12]) if protocol else None


def _with_header(size: int, protocol: _Protocol, header: bytes) -> HesaiLayout | None:
    """The layout that a header describes; None if the packet has another size."""
    channels, blocks, unit_mm = header[0], header[1], header[3]
    flags = Flag(header[5] & 0x7F)
    if not 0 < channels * blocks <= _MAX_SHOTS or not unit_mm:
        return None
    optional = sum(bool(flags & part) for part in (Flag.CONFIDENCE, Flag.WEIGHT, Flag.LIGHT))
    return_bytes = protocol.return_bytes or 3 + optional
    returns_at = 3 if protocol.fine_azimuth else 2
    block_bytes = returns_at + return_bytes * channels
    safety = protocol.sums and not protocol.fine_azimuth and bool(flags & Flag.SAFETY)
    tail_at = (
        protocol.header
        + block_bytes * blocks
        + _Bytes.CRC * protocol.sums
        + _Bytes.SAFETY * int(safety)
    )
    rest = size - tail_at - protocol.tail.size
    layout = HesaiLayout(
        size=size,
        channels=channels,
        blocks=blocks,
        blocks_at=protocol.header,
        block_bytes=block_bytes,
        azimuth_at=0,
        returns_at=returns_at,
        return_bytes=return_bytes,
        unit_mm=unit_mm,
        tail_at=tail_at,
        tail=protocol.tail,
        **_behind_tail(size - rest, protocol, flags),
    )
    return layout if rest in _rests(protocol, flags) else None


def _behind_tail(at: int, protocol: _Protocol, flags: Flag) -> dict[str, int]:
    """Offsets of the optional parts behind the tail, by field of `HesaiLayout`."""
    if not protocol.sums:
        return {}
    at += _Bytes.SEQUENCE * bool(flags & Flag.SEQUENCE)
    has_imu = protocol.tail is _PANDAR128 and bool(flags & Flag.IMU)
    return {"imu_at": at if has_imu else -1, "crc_at": at + _Bytes.IMU * has_imu}


def _rests(protocol: _Protocol, flags: Flag) -> tuple[int, ...]:
    """Bytes that may follow the tail."""
    if not protocol.sums:  # old firmware leaves the flag of the sequence number at 0
        return (0, _Bytes.SEQUENCE)
    sequence = _Bytes.SEQUENCE * bool(flags & Flag.SEQUENCE)
    imu = _Bytes.IMU * (protocol.tail is _PANDAR128 and bool(flags & Flag.IMU))
    least = sequence + imu + _Bytes.CRC
    return (least + _Bytes.SIGNATURE * bool(flags & Flag.SIGNATURE),)


def _pandar40p(size: int) -> HesaiLayout:
    return HesaiLayout(
        size=size,
        channels=40,
        blocks=10,
        blocks_at=0,
        block_bytes=124,
        azimuth_at=2,
        returns_at=4,
        return_bytes=3,
        unit_mm=4,
        tail_at=1240,
        tail=_PANDAR,
    )


def _jt16() -> HesaiLayout:
    return HesaiLayout(
        size=JT16_SIZE,
        channels=16,
        blocks=1,
        blocks_at=16,
        block_bytes=50,
        azimuth_at=0,
        returns_at=2,
        return_bytes=3,
        unit_mm=4,
        tail_at=6,
        tail=_JT16,
        crc_at=JT16_SIZE - _Bytes.CRC,
    )
