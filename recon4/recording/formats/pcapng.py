"""Packets of a pcapng file, block by block; every length is checked before it is read.

Blocks and options: https://datatracker.ietf.org/doc/draft-ietf-opsawg-pcapng/ (sections 3 and 4).
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import SEEK_CUR
from typing import IO, NamedTuple

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText

MAGIC = b"\x0a\x0d\x0d\x0a"
CLASSIC = {
    b"\xd4\xc3\xb2\xa1": ("<", 1000),
    b"\xa1\xb2\xc3\xd4": (">", 1000),
    b"\x4d\x3c\xb2\xa1": ("<", 1),
    b"\xa1\xb2\x3c\x4d": (">", 1),
}
"""First four bytes of a pcap file, which has no blocks: byte order and unit of its times [ns]."""
MAX_BLOCK_BYTES = 16 << 20
MAX_INTERFACES = 1024
MAX_PACKET_BYTES = 262_144
"""The largest capture length in use."""
_SECTION, _INTERFACE, _OLD_PACKET, _SIMPLE_PACKET, _PACKET = 0x0A0D0D0A, 1, 2, 3, 6
_TSRESOL, _TSOFFSET = 9, 14
_MAX_TIME_NS = 2**62


@dataclass(frozen=True, slots=True)
class Interface:
    """An interface of the capture."""

    link_type: int
    ticks_per_s: int
    offset_s: int

    def t_ns(self, ticks: int) -> int:
        """Time of capture [ns]."""
        return self.offset_s * 1_000_000_000 + ticks * 1_000_000_000 // self.ticks_per_s


class Packet(NamedTuple):
    """One captured packet."""

    t_ns: int
    link_type: int
    data: bytes


def read_packets(file: IO[bytes], skipped: Callable[[str], None]) -> Iterator[Packet]:
    """Stream the packets of a pcapng file from its start.

    Args:
        file: Open for reading bytes, at its start; a pcap file may follow, which is left.
        skipped: Receives the name of a count for a packet that has no usable time.

    Raises:
        CorruptFile: If a block makes no sense or is cut off; the packets before it were given.
    """
    order, interfaces, at = "<", list[Interface](), 0
    while head := _read(file, 8):
        if head[:4] in CLASSIC:
            file.seek(-len(head), SEEK_CUR)
            return
        where = f"block at byte {at}"
        order = _order(file, head, order, where=where)
        kind, body, length = _block(file, head, order, where=where)
        at += length
        if kind == _SECTION:
            interfaces = []
        elif kind == _INTERFACE:
            if len(interfaces) >= MAX_INTERFACES:
                raise CorruptFile(
                    CodedText("pcapng-interfaces", where=where, max_interfaces=MAX_INTERFACES)
                )
            interfaces.append(_interface(body, order, where))
        elif kind == _SIMPLE_PACKET:
            skipped("records_without_time")
        elif kind in {_PACKET, _OLD_PACKET}:
            packet = _packet(kind, body, order, known=(interfaces, where))
            if 0 <= packet.t_ns < _MAX_TIME_NS:
                yield packet
            else:
                skipped("records_without_time")


def _order(file: IO[bytes], head: bytes, order: str, *, where: str) -> str:
    """Byte order of the section, from four bytes that `_block` reads again."""
    if head[:4] != MAGIC:
        return order
    magic = _read(file, 4)
    file.seek(-len(magic), SEEK_CUR)
    if magic not in {b"\x4d\x3c\x2b\x1a", b"\x1a\x2b\x3c\x4d"}:
        raise CorruptFile(CodedText("pcapng-order", where=where, magic=magic.hex(" ")))
    return "<" if magic[0] == 0x4D else ">"


def _block(file: IO[bytes], head: bytes, order: str, *, where: str) -> tuple[int, bytes, int]:
    """Kind, body and length of a block."""
    if len(head) < 8:
        raise CorruptFile(CodedText("pcapng-cut", where=where, count=len(head)))
    kind, length = struct.unpack(f"{order}II", head)
    if not 12 <= length <= MAX_BLOCK_BYTES or length % 4:
        raise CorruptFile(
            CodedText(
                "pcapng-length", where=where, max_block_bytes=MAX_BLOCK_BYTES, length=str(length)
            )
        )
    rest = _read(file, length - 8)
    if len(rest) < length - 8:
        raise CorruptFile(
            CodedText("pcapng-block-cut", where=where, length=str(length), count=len(rest) + 8)
        )
    (again,) = struct.unpack_from(f"{order}I", rest, length - 12)
    if again != length:
        raise CorruptFile(
            CodedText("pcapng-length-twice", where=where, length=str(length), again=str(again))
        )
    return kind, rest[:-4], length


def _read(file: IO[bytes], length: int) -> bytes:
    """Read the available bytes; a growing file may deliver them in pieces."""
    found = file.read(length)
    while 0 < len(found) < length and (more := file.read(length - len(found))):
        found += more
    return found


def _interface(body: bytes, order: str, where: str) -> Interface:
    if len(body) < 8:
        raise CorruptFile(CodedText("pcapng-interface", where=where, count=len(body)))
    (link_type,) = struct.unpack_from(f"{order}H", body)
    ticks_per_s, offset_s = 1_000_000, 0
    at = 8
    while at + 4 <= len(body):
        code, length = struct.unpack_from(f"{order}HH", body, at)
        value = body[at + 4 : at + 4 + length]
        if code == _TSRESOL and length == 1 and value:
            ticks_per_s = (2 if value[0] & 128 else 10) ** (value[0] & 127)
        elif code == _TSOFFSET and len(value) == 8:
            (offset_s,) = struct.unpack(f"{order}q", value)
        at += 4 + length + (-length % 4)
        if not code:
            break
    return Interface(link_type, ticks_per_s, offset_s)


def _packet(kind: int, body: bytes, order: str, *, known: tuple[list[Interface], str]) -> Packet:
    interfaces, where = known
    layout = f"{order}IIIII" if kind == _PACKET else f"{order}H2xIIII"
    size = struct.calcsize(layout)
    if len(body) < size:
        raise CorruptFile(CodedText("pcapng-packet", where=where, size=size, count=len(body)))
    number, high, low, captured, _ = struct.unpack_from(layout, body)
    if number >= len(interfaces):
        raise CorruptFile(
            CodedText(
                "pcapng-interface-number", where=where, count=len(interfaces), number=str(number)
            )
        )
    most = min(MAX_PACKET_BYTES, len(body) - size)
    if captured > most:
        raise CorruptFile(
            CodedText("pcapng-packet-large", where=where, most=most, captured=str(captured))
        )
    source = interfaces[number]
    data = body[size : size + captured]
    return Packet(source.t_ns(high << 32 | low), source.link_type, data)
