"""E57 files with an XML section given by a test, and correct checksums."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pye57
from pye57 import libe57

from recon4.recording.formats.e57_xml import _checksums

_HEADER = struct.Struct("<8sIIQQQQ")


def write_sound(path: Path, points: int = 500) -> None:
    p = np.random.default_rng(0).random((3, points))
    with pye57.E57(str(path), mode="w") as file:
        file.write_scan_raw(dict(zip(("cartesianX", "cartesianY", "cartesianZ"), p, strict=True)))


def write_constant(path: Path, *, points: int, scans: int) -> None:
    """Scans of points at the origin, whose scaled coordinates take no bits."""
    with pye57.E57(str(path), mode="w") as file:
        image = file.image_file
        for _ in range(scans):
            prototype = libe57.StructureNode(image)
            for axis in "XYZ":
                node = libe57.ScaledIntegerNode(image, 0, 0, 0, 0.001, 0.0)
                prototype.set(f"cartesian{axis}", node)
            codecs = libe57.VectorNode(image, True)
            vector = libe57.CompressedVectorNode(image, prototype, codecs)
            scan = libe57.StructureNode(image)
            scan.set("points", vector)
            file.data3d.append(scan)
            data = {f"cartesian{axis}": np.zeros(points and 1_000_000) for axis in "XYZ"}
            buffers = libe57.VectorSourceDestBuffer()
            for name, values in data.items():
                buffer = libe57.SourceDestBuffer(image, name, values, len(values), True, True)
                buffers.append(buffer)
            writer = vector.writer(buffers)
            for first in range(0, points, 1_000_000):
                writer.write(min(1_000_000, points - first))
            writer.close()


def with_xml(source: Path, target: Path, change) -> Path:
    """A copy whose XML section went through ``change(bytes) -> bytes``."""
    data = source.read_bytes()
    magic, major, minor, _, offset, length, page = _HEADER.unpack(data[: _HEADER.size])
    logical = b"".join(data[i : i + 1020] for i in range(0, len(data), 1024))
    begin = offset // 1024 * 1020 + offset % 1024
    xml = change(logical[begin : begin + length])
    logical = logical[:begin] + xml
    logical += bytes(-len(logical) % 1020)
    count = len(logical) // 1020
    head = _HEADER.pack(magic, major, minor, 1024 * count, offset, len(xml), page)
    rows = np.frombuffer(head + logical[_HEADER.size :], np.uint8).reshape(count, 1020)
    sums = np.array(_checksums(rows), ">u4").view(np.uint8).reshape(count, 4)
    target.write_bytes(np.hstack([rows, sums]).tobytes())
    return target
