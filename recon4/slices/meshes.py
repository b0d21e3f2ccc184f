"""Triangle meshes as references; PLY is read here, with its lengths checked first."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from recon4.errors import CorruptFile
from recon4.evaluation.mesh import Mesh, read_mesh
from recon4.recording.cloud_files import read_cloud

_FACES = re.compile(rb"element\s+face\s+(\d+)")
_HEAD = 64 * 1024
_SIZES = {
    **dict.fromkeys((b"uchar", b"uint8", b"char", b"int8"), "u1"),
    **dict.fromkeys((b"int", b"int32"), "i4"),
    **dict.fromkeys((b"uint", b"uint32"), "u4"),
    **dict.fromkeys((b"ushort", b"uint16"), "u2"),
}
_VERTEX_BYTES = {
    **dict.fromkeys((b"char", b"uchar", b"int8", b"uint8"), 1),
    **dict.fromkeys((b"short", b"ushort", b"int16", b"uint16"), 2),
    **dict.fromkeys((b"int", b"uint", b"int32", b"uint32", b"float", b"float32"), 4),
    **dict.fromkeys((b"double", b"float64"), 8),
}


def is_mesh(path: Path) -> bool:
    """Whether a file is a mesh: OBJ, STL, or a PLY with faces."""
    if path.suffix.lower() in {".obj", ".stl"}:
        return True
    with path.open("rb") as file:
        head = file.read(_HEAD)
    faces = _FACES.search(head.split(b"end_header")[0]) if head[:3] == b"ply" else None
    return faces is not None and int(faces[1]) > 0


def load_mesh(path: Path) -> Mesh:
    """Read a triangle mesh.

    Raises:
        CorruptFile: If bytes are missing, faces are not triangles, or corners do not exist.
        RecordingError: If it cannot be opened.
    """
    with path.open("rb") as file:
        head = file.read(_HEAD)
    if head[:3] != b"ply":
        return _sound(read_mesh(path), path.name)
    if b"format ascii" in head:
        _check_lines(path, head)
        return _sound(read_mesh(path), path.name)
    return _sound(_binary_ply(path, head), path.name)


def _binary_ply(path: Path, head: bytes) -> Mesh:
    """Vertices by the reader of clouds, which checks their length; the faces behind them here."""
    top = head.split(b"end_header")[0]
    counts = {kind: int(n) for kind, n in re.findall(rb"element\s+(\w+)\s+(\d+)", top)}
    order = "<" if b"binary_little" in top else ">"
    rows = counts.get(b"face", 0)
    if list(counts) != [b"vertex", b"face"]:
        raise CorruptFile(f"{path.name}: expected the elements vertex and face, in this order")
    row = _face_row(top, order, path.name)
    table = read_cloud(path)
    if any(axis not in table for axis in "xyz"):
        raise CorruptFile(f"{path.name}: the vertices have no x, y, z")
    start = head.find(b"\n", head.find(b"end_header")) + 1
    start += counts[b"vertex"] * _vertex_bytes(top)
    needed, left = rows * row.itemsize, path.stat().st_size - start
    if left != needed:
        raise CorruptFile(
            f"{path.name}: {rows} triangles need {needed} bytes behind the vertices, got {left} "
            "(cut, or faces that are not triangles: triangulate the mesh)"
        )
    faces = np.fromfile(path, row, rows, offset=start)
    if np.any(faces["n"] != 3):
        raise CorruptFile(f"{path.name}: faces that are not triangles: triangulate the mesh")
    vertices = np.column_stack([table[axis] for axis in "xyz"]).astype(np.float64)
    return Mesh(vertices, faces["corner"].astype(np.int64))


def _face_row(top: bytes, order: str, name: str) -> np.dtype[np.void]:
    """A triangle in the file: its corners and whatever else a face has."""
    fields: list[Any] = []
    for words in re.findall(rb"property\s+([^\r\n]+)", top.split(b"element face")[1]):
        kind, *rest = words.split()
        try:
            if kind == b"list":
                fields.append(("n", order + _SIZES[rest[0]]))
                fields.append(("corner", order + _SIZES[rest[1]], (3,)))
            else:
                fields.append((f"extra{len(fields)}", f"V{_VERTEX_BYTES[kind]}"))
        except (KeyError, IndexError) as error:
            raise CorruptFile(f"{name}: PLY faces of unknown type: {words!r}") from error
    if sum(field[0] == "corner" for field in fields) != 1:
        raise CorruptFile(f"{name}: PLY faces need one list of corners")
    return np.dtype(fields)


def _vertex_bytes(top: bytes) -> int:
    vertex = top.split(b"element vertex")[1].split(b"element")[0]
    return sum(_VERTEX_BYTES[kind] for kind in re.findall(rb"property\s+(\w+)\s+\w+", vertex))


def _check_lines(path: Path, head: bytes) -> None:
    promised = sum(int(n) for n in re.findall(rb"element\s+\w+\s+(\d+)", head))
    with path.open("rb") as file:
        lines = sum(chunk.count(b"\n") for chunk in iter(lambda: file.read(1 << 20), b""))
    lines -= head.split(b"end_header")[0].count(b"\n")
    if lines < promised:
        raise CorruptFile(f"{path.name}: cut: {promised} lines promised, got {lines}")


def _sound(mesh: Mesh, name: str) -> Mesh:
    corners = mesh.triangles
    if not len(corners) or corners.min() < 0 or corners.max() >= len(mesh.vertices_m):
        raise CorruptFile(f"{name}: triangles name corners that do not exist")
    if not np.isfinite(mesh.vertices_m).all():
        raise CorruptFile(f"{name}: corners have coordinates that are not numbers")
    return mesh
