"""What recorders write: classic captures and pcapng, whole, cut, of other link types."""

from __future__ import annotations

import struct
from collections.abc import Iterable

import numpy as np

from recon4.recording.packets.velodyne.models import DATA_SIZE, DUAL
from recon4.recording.packets.velodyne.sound_packets import as_packets

_RECORD = 16
_HEADERS = 42
"""Bytes of Ethernet, IPv4 and UDP."""


def points_in(captured: Iterable[bytes]) -> int:
    """Returns in the whole data packets among captured ones, each packet counted once.

    Both returns of a shot in dual return mode count, unless they are the same.
    """
    whole = {p[_HEADERS:] for p in captured if len(p) == _HEADERS + DATA_SIZE}
    if not whole:
        return 0
    packets = as_packets(np.frombuffer(b"".join(whole), np.uint8).reshape(-1, DATA_SIZE))
    seen = packets["blocks"]["returns"]["distance"]
    is_dual = packets["return_mode"] == DUAL
    last, strongest = seen[is_dual, ::2], seen[is_dual, 1::2]
    second = np.count_nonzero((last != strongest) & (last > 0)) + np.count_nonzero(strongest)
    return int(np.count_nonzero(seen[~is_dual]) + second)


def spoil_file(draw, variant):
    """Rewrite the capture as another recorder would, or damage it; counts what is left."""
    data = variant.path.read_bytes()
    variant.points = points_in(packet for _, packet in _records(data))
    how = draw.one(
        *("", "", "", "pcapng", "pcapng", "cut pcapng"),
        *("cut", "snap length", "microseconds", "cooked", "cooked v2", "VLAN"),
    )
    if how:
        variant.say(f"file {how}")
    if how == "cut":
        rest = data[: int(len(data) * draw.one(0.5, 0.95))]
        variant.path.write_bytes(rest)
        variant.points = points_in(packet for _, packet in _records(rest))
    elif how == "snap length":
        ratio = draw.one(1.0, 0.1)
        snapped = _snapped(draw, data, ratio)
        variant.path.write_bytes(snapped)
        variant.refusal = "all packets are cut" if ratio == 1.0 else ""
        variant.points = points_in(packet for _, packet in _records(snapped))
    elif how == "microseconds":
        variant.path.write_bytes(struct.pack("<I", 0xA1B2C3D4) + _in_microseconds(data[4:]))
    elif how == "cooked":
        variant.path.write_bytes(_cooked(data))
    elif how == "cooked v2":
        variant.path.write_bytes(_cooked_v2(data))
    elif how == "VLAN":
        variant.path.write_bytes(_tagged(data))
    elif how.endswith("pcapng"):
        _write_pcapng(draw, variant, data, is_cut=how != "pcapng")


def _records(data):
    at = 24
    while at + _RECORD <= len(data):
        stamp = data[at : at + 8]
        length = struct.unpack_from("<I", data, at + 8)[0]
        packet = data[at + _RECORD : at + _RECORD + length]
        if len(packet) < length:
            return
        yield stamp, packet
        at += _RECORD + length


def _snapped(draw, data, ratio):
    parts = [data[:24]]
    for stamp, packet in _records(data):
        kept = packet[:1000] if draw.chance(ratio) else packet
        parts += [stamp, struct.pack("<II", len(kept), len(packet)), kept]
    return b"".join(parts)


def _in_microseconds(data):
    parts = [data[:20]]
    for stamp, packet in _records(b"\0\0\0\0" + data):
        seconds, nanoseconds = struct.unpack("<II", stamp)
        parts.append(struct.pack("<IIII", seconds, nanoseconds // 1000, *[len(packet)] * 2))
        parts.append(packet)
    return b"".join(parts)


def _cooked(data):
    parts = [data[:20] + struct.pack("<I", 113)]
    for stamp, packet in _records(data):
        cooked = struct.pack(">HHH", 0, 1, 6) + packet[6:12] + b"\0\0" + packet[12:]
        parts += [stamp, struct.pack("<II", *[len(cooked)] * 2), cooked]
    return b"".join(parts)


def _cooked_v2(data):
    parts = [data[:20] + struct.pack("<I", 276)]
    for stamp, packet in _records(data):
        head = struct.pack(">HHIHBB8s", 0x0800, 0, 2, 1, 0, 6, packet[6:12] + b"\0\0")
        cooked = head + packet[14:]
        parts += [stamp, struct.pack("<II", *[len(cooked)] * 2), cooked]
    return b"".join(parts)


def _tagged(data):
    parts = [data[:24]]
    for stamp, packet in _records(data):
        tagged = packet[:12] + struct.pack(">HH", 0x8100, 7) + packet[12:]
        parts += [stamp, struct.pack("<II", *[len(tagged)] * 2), tagged]
    return b"".join(parts)


def _write_pcapng(draw, variant, data, *, is_cut):
    """As Wireshark writes it: an interface without packets before the one of the LiDAR."""
    scale, option = draw.one((1, b"\x09"), (1000, b"\x06"), (1000, b""))
    variant.say(f"in steps of {scale} ns")
    options = struct.pack("<HH", 9, 1) + option + bytes(7) if option else b""
    parts = [
        _block(0x0A0D0D0A, struct.pack("<IHHq", 0x1A2B3C4D, 1, 0, -1)),
        _block(1, struct.pack("<HHI", 101, 0, 65535)),
        _block(1, struct.pack("<HHI", 1, 0, 0) + options),
    ]
    for stamp, packet in _records(data):
        seconds, nanoseconds = struct.unpack("<II", stamp)
        ticks = (seconds * 10**9 + nanoseconds) // scale
        head = struct.pack("<5I", 1, ticks >> 32, ticks & 0xFFFF_FFFF, len(packet), len(packet))
        parts.append(_block(6, head + packet + bytes(-len(packet) % 4)))
    parts.append(_block(5, struct.pack("<III", 1, 0, 0)))
    whole = b"".join(parts)
    variant.path = variant.path.with_suffix(".pcapng")
    if is_cut:
        kept = int(0.9 * len(parts))
        whole = b"".join(parts[:kept]) + parts[kept][:40]
        variant.points = points_in(packet for _, packet in list(_records(data))[: kept - 3])
        variant.damaged = True
    variant.path.write_bytes(whole)


def _block(kind, body):
    size = len(body) + 12
    return struct.pack("<II", kind, size) + body + struct.pack("<I", size)
