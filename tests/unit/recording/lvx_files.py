"""LVX files written from packets, by the specifications of the maker."""

from __future__ import annotations

import struct
from collections.abc import Sequence

import numpy as np

from recon4.recording.packets.livox.models import SDK2_HEADER

MAGIC_CODE = 0xAC0EA767
Extrinsic = tuple[float, float, float, float, float, float]
"""Roll, pitch, yaw [°], x, y, z [m]."""


def lvx(
    frames: Sequence[Sequence[tuple[int, np.ndarray]]],
    *,
    version: tuple[int, int] = (1, 1),
    extrinsics: Sequence[Extrinsic | None] = (None,),
) -> bytes:
    """A file.

    Args:
        frames: Of each frame its packets: row of the device, payload.
        version: 1.0, 1.1 or 2.0.
        extrinsics: Of each device; None = not used.
    """
    whole = struct.pack("<16s4BI", b"livox_tech", *version, 0, 0, MAGIC_CODE)
    whole += b"" if version == (1, 0) else struct.pack("<I", 50)
    whole += bytes([len(extrinsics)])
    for row, extrinsic in enumerate(extrinsics):
        whole += _device(row, extrinsic, version)
    for number, packets in enumerate(frames):
        body = b"".join(_package(row, payload, version) for row, payload in packets)
        extra = struct.pack("<Q", len(packets)) if version == (1, 0) else b""
        after = len(whole) + 24 + len(extra) + len(body)
        whole += struct.pack("<QQQ", len(whole), after, number) + extra + body
    return whole


def _device(row: int, extrinsic: Extrinsic | None, version: tuple[int, int]) -> bytes:
    serial = f"SN{row:013d}".encode()
    numbers = struct.pack("<6f", *(extrinsic or (0.0,) * 6))
    if version == (2, 0):
        kinds = bytes([247, 9, extrinsic is not None])
        return struct.pack("<16s16sI", serial, b"", 0xC0A80164 + row) + kinds + numbers
    flag = b"" if version == (1, 0) else bytes([extrinsic is not None])
    return struct.pack("<16s16sBB", serial, b"", row, 1) + flag + numbers


def _package(row: int, payload: np.ndarray, version: tuple[int, int]) -> bytes:
    if version != (2, 0):
        return bytes([row]) + payload.tobytes()
    header = payload[: SDK2_HEADER.itemsize].copy().view(SDK2_HEADER)[0]
    body = payload[SDK2_HEADER.itemsize :].tobytes()
    return (
        struct.pack("<BIBB", header["version"], 0xC0A80164 + row, 8, header["time_type"])
        + header["stamp"].tobytes()
        + struct.pack("<HBIB4x", header["counter"], header["data_type"], len(body), header["frame"])
        + body
    )
