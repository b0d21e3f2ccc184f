"""Capture files that ask for too much memory."""

from __future__ import annotations

import struct
from pathlib import Path

from tests.security.compressed_zeros import stretch

_PCAP_HEAD = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 262144, 1)


def _datagram(source: int, port: int) -> bytes:
    udp = struct.pack(">HHHH", 1000, port, 8, 0)
    ip = struct.pack(">BBHHHBBHII", 0x45, 0, 28, 0, 0, 64, 17, 0, source, 1)
    return bytes(12) + b"\x08\x00" + ip + udp


def pcap_sparse(path: Path) -> None:
    path.write_bytes(_PCAP_HEAD)
    stretch(path)


def pcap_tiny_datagrams(path: Path) -> None:
    """A million datagrams without content in 58 MB."""
    packet = _datagram(1, 2368)
    path.write_bytes(
        _PCAP_HEAD + (struct.pack("<IIII", 1, 1, len(packet), len(packet)) + packet) * 1_000_000
    )


def pcap_many_senders(path: Path) -> None:
    """A hundred thousand senders, one datagram each."""
    parts = []
    for k in range(100_000):
        packet = _datagram(k, k % 60_000)
        parts.append(struct.pack("<IIII", 1, k, len(packet), len(packet)) + packet)
    path.write_bytes(_PCAP_HEAD + b"".join(parts))


_SECTION = struct.pack("<IIIHHqI", 0x0A0D0D0A, 28, 0x1A2B3C4D, 1, 0, -1, 28)


def pcapng_short_block(path: Path) -> None:
    """A block whose length is less than its head: a naive reader reads the whole file."""
    path.write_bytes(_SECTION + struct.pack("<II", 1, 4))
    stretch(path)


def pcapng_long_block(path: Path) -> None:
    path.write_bytes(_SECTION + struct.pack("<II", 1, 0xFFFF_FFF0))
    stretch(path)


def pcapng_interfaces(path: Path) -> None:
    """Two million interfaces in 40 MB."""
    path.write_bytes(_SECTION + struct.pack("<IIHHII", 1, 20, 1, 0, 0, 20) * 2_000_000)


def pcapng_sparse(path: Path) -> None:
    path.write_bytes(_SECTION + struct.pack("<IIHHII", 1, 20, 1, 0, 0, 20))
    stretch(path)
