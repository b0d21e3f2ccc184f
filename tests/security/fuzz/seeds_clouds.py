"""Tiny valid files of clouds and meshes, made by code."""

from __future__ import annotations

import io
import struct
import tempfile
from functools import cache
from pathlib import Path

import laspy
import numpy as np

from tests.builders import lzf_literals, write_bin, write_pcd, write_ply

POINTS = 40


def table(count: int = POINTS) -> dict[str, np.ndarray]:
    """Points of a small cloud as columns."""
    rng = np.random.default_rng(4)
    x, y, z = rng.uniform(-5.0, 5.0, (3, count)).astype(np.float32)
    return {
        "x": x,
        "y": y,
        "z": z,
        "intensity": rng.integers(0, 255, count).astype(np.float32),
        "ring": (np.arange(count) % 16).astype(np.uint16),
    }


@cache
def pcd() -> tuple[bytes, ...]:
    """Ascii, binary with padding, and compressed with back references."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.pcd"
        plain = [
            write_pcd(path, table(), encoding=e, padding=p).read_bytes()
            for e, p in (("ascii", 0), ("binary", 3), ("binary_compressed", 0))
        ]
    return (*plain, _compressed(plain[2]))


def _compressed(data: bytes) -> bytes:
    """The compressed seed again, all points at 0: one literal run and back references."""
    head = data[: data.index(b"binary_compressed\n") + len(b"binary_compressed\n")]
    size = POINTS * (4 * 4 + 2)
    packed, done = lzf_literals(bytes(8)), 8
    while done < size:
        length = min(264, size - done)
        if length < 3:
            packed += bytes([length - 1]) + bytes(length)
        elif length < 9:
            packed += bytes([(length - 2) << 5, 0])
        else:
            packed += bytes([7 << 5, length - 9, 0])
        done += length
    return head + struct.pack("<II", len(packed), size) + packed


@cache
def ply() -> tuple[bytes, ...]:
    """Clouds in the three encodings, with and without a list; meshes ascii and binary."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.ply"
        clouds = [
            write_ply(path, table(), encoding=e).read_bytes()
            for e in ("ascii", "binary_little_endian")
        ]
    return (*clouds, mesh_ply(ascii=True), mesh_ply(ascii=False))


def mesh_ply(*, ascii: bool) -> bytes:
    """A tetrahedron."""
    order = "ascii" if ascii else "binary_little_endian"
    head = (
        f"ply\nformat {order} 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()
    if ascii:
        lines = [" ".join(f"{v:g}" for v in p) for p in CORNERS]
        lines += [f"3 {a} {b} {c}" for a, b, c in FACES]
        return head + ("\n".join(lines) + "\n").encode()
    body = np.array(CORNERS, "<f4").tobytes()
    return head + body + b"".join(struct.pack("<B3i", 3, *face) for face in FACES)


CORNERS = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))


@cache
def kitti_bin() -> tuple[bytes, ...]:
    """A cloud of the KITTI data set."""
    with tempfile.TemporaryDirectory() as folder:
        return (write_bin(Path(folder) / "a.bin", table(200)).read_bytes(),)


@cache
def obj() -> tuple[bytes, ...]:
    """Corners counted from 1, from the end, with texture and normal, a quadrangle."""
    v = "".join(f"v {a:g} {b:g} {c:g}\n" for a, b, c in CORNERS)
    f = "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in FACES)
    full = f"# a comment\nmtllib a.mtl\no one\n{v}vt 0 0\nvn 0 0 1\ng x\nusemtl m\ns off\n"
    full += "f 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\nf -4 -2 -1 -3\n"
    return (v + f).encode(), full.encode()


@cache
def stl() -> tuple[bytes, ...]:
    """Binary and ascii."""
    triangles = np.array(CORNERS)[np.array(FACES)]
    binary = b"a mesh".ljust(80) + struct.pack("<I", len(FACES))
    text = "solid a\n"
    for corners in triangles:
        binary += struct.pack("<12fH", 0, 0, 1, *corners.reshape(-1), 0)
        text += "  facet normal 0 0 1\n    outer loop\n"
        text += "".join(f"      vertex {a:e} {b:e} {c:e}\n" for a, b, c in corners)
        text += "    endloop\n  endfacet\n"
    return binary, (text + "endsolid a\n").encode()


@cache
def las(*, compressed: bool) -> tuple[bytes, ...]:
    """LAS 1.2 with legacy points, and 1.4 with extra bytes."""
    out = []
    for version, point_format in (("1.2", 3), ("1.4", 6)):
        header = laspy.LasHeader(version=version, point_format=point_format)
        header.scales, header.offsets = np.full(3, 0.001), np.zeros(3)
        if version == "1.4":
            header.add_extra_dims([laspy.ExtraBytesParams("ring", "u1", "beam")])
        points = laspy.ScaleAwarePointRecord.zeros(POINTS, header=header)
        cloud = table()
        points.x, points.y, points.z = cloud["x"], cloud["y"], cloud["z"]
        file = io.BytesIO()
        with laspy.open(file, "w", header=header, do_compress=compressed, closefd=False) as writer:
            writer.write_points(points)
        out.append(file.getvalue())
    return tuple(out)


@cache
def e57() -> tuple[bytes, ...]:
    """One scan."""
    import pye57

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.e57"
        file = pye57.E57(str(path), mode="w")
        cloud = table()
        raw = {f"cartesian{k.upper()}": cloud[k].astype(np.float64) for k in "xyz"}
        file.write_scan_raw(raw | {"intensity": cloud["intensity"].astype(np.float64)})
        file.close()
        return (path.read_bytes(),)


_CRC32C = [0] * 256
for _k in range(256):
    _value = _k
    for _ in range(8):
        _value = (_value >> 1) ^ (0x82F63B78 if _value & 1 else 0)
    _CRC32C[_k] = _value


def e57_checksums(data: bytes) -> bytes:
    """Make the checksum of every page of 1024 bytes fit again."""
    out = bytearray(data)
    for start in range(0, len(out) - 1023, 1024):
        crc = 0xFFFFFFFF
        for byte in out[start : start + 1020]:
            crc = (crc >> 8) ^ _CRC32C[(crc ^ byte) & 0xFF]
        out[start + 1020 : start + 1024] = struct.pack(">I", crc ^ 0xFFFFFFFF)
    return bytes(out)


@cache
def xyz() -> tuple[bytes, ...]:
    """Blanks; a head line with commas; semicolons with decimal commas."""
    rows = np.column_stack([table()[k] for k in "xyz"]).tolist()
    blank = "".join(f"{x:.3f} {y:.3f} {z:.3f} 12\n" for x, y, z in rows)
    comma = "x,y,z\n" + "".join(f"{x:.3f},{y:.3f},{z:.3f}\n" for x, y, z in rows)
    german = comma.replace("x,y,z", "x;y;z").replace(",", ";").replace(".", ",")
    return blank.encode(), comma.encode(), german.encode()


@cache
def ptx() -> tuple[bytes, ...]:
    """Two scans of one row."""
    rows = np.column_stack([table()[k] for k in "xyz"]).tolist()
    pose = "1 2 3\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n"
    scan = "".join(f"{x:.3f} {y:.3f} {z:.3f} 0.5\n" for x, y, z in rows)
    return ((2 * f"{len(rows)}\n1\n{pose}{scan}").encode(),)
