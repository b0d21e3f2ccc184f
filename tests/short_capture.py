"""The beginning of a capture, and how tests map it: a short recording takes less time."""

from __future__ import annotations

import struct
from pathlib import Path

QUICK = ("map.voxel_m=0.1", "graph.node_stride=4")
"""Settings that make a short run short."""
_FILE_HEADER = 24
_PACKET_HEADER = struct.Struct("<IIII")
"""Seconds, nanoseconds, bytes stored and bytes sent."""
_NANOSECONDS = 0xA1B23C4D


def cut_capture(source: Path, target: Path, *, seconds: float) -> None:
    """Copy the packets of the first seconds of a capture with nanoseconds, byte for byte."""
    data = source.read_bytes()
    assert struct.unpack_from("<I", data)[0] == _NANOSECONDS
    at, begin_ns = _FILE_HEADER, None
    while at < len(data):
        whole_s, rest_ns, stored, _ = _PACKET_HEADER.unpack_from(data, at)
        t_ns = whole_s * 1_000_000_000 + rest_ns
        begin_ns = t_ns if begin_ns is None else begin_ns
        if t_ns >= begin_ns + seconds * 1e9:
            break
        at += _PACKET_HEADER.size + stored
    target.write_bytes(data[:at])


def process_short(walk: Path, out: Path) -> list[str]:
    """Arguments of ``recon4`` that map the short recording in a folder."""
    sensors = ["--rig", "4recon", "--imu", str(walk / "imu.csv")]
    quick = [word for one in QUICK for word in ("--set", one)]
    return ["process", str(walk / "recording.pcap"), *sensors, "--out", str(out), *quick]
