"""Readers of triangle meshes: PLY, OBJ and STL, line by line or with their lengths checked first.

Other files that a mesh names (materials, textures) are never opened.
"""

from __future__ import annotations

import os
import re
from array import array
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.evaluation.tuning import MESH_FILES
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.recording.formats.cloud_files import read_cloud
from recon4.recording.formats.cloud_headers import HEADER_BYTES, is_ply, ply_layout, whole
from recon4.untrusted.bounded import lines_limited, open_regular

Corners = tuple[Array, NDArray[np.int64]]
"""Vertices [m], (V, 3), and triangles as rows of them, (T, 3)."""

_INTEGERS = {
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("short", "int16"), "i2"),
}
_OTHER_BYTES = {"float": 4, "float32": 4, "double": 8, "float64": 8}
_STL_ROW = np.dtype([("normal", "<f4", (3,)), ("corner", "<f4", (3, 3)), ("extra", "<u2")])
_STL_HEAD = 84


def read_triangles(path: Path) -> Corners:
    """Read the vertices and triangles of a PLY, OBJ or STL file; polygons become fans.

    Raises:
        CorruptFile: Naming the place, what was expected and what was found.
    """
    with open_regular(path) as file:
        head = file.read(HEADER_BYTES)
    if is_ply(head):
        return _ply(path, head)
    if path.suffix.lower() == ".obj":
        return _obj(path)
    if path.suffix.lower() == ".stl":
        return _stl(path, head)
    raise CorruptFile(CodedText("mesh-expected", file=path.name))


# -- OBJ


def _obj(path: Path) -> Corners:
    vertices, triangles = array("d"), array("q")
    for number, line in _lines(path):
        words = line.partition("#")[0].split()
        if not words or words[0] not in ("v", "f"):
            continue
        where = f"{path.name}: line {number}"
        if words[0] == "v":
            vertices.extend(_numbers(words[1:4], 3, where))
        else:
            count = len(vertices) // 3
            corners = [_obj_corner(word, count, where) for word in words[1:]]
            _fan(triangles, corners, where)
    return _arrays(vertices, triangles)


def _obj_corner(word: str, count: int, where: str) -> int:
    """``7``, ``7/1/2`` or ``-1``: counted from 1, or back from the last one."""
    text = word.partition("/")[0]
    try:
        number = -whole(text[1:]) if text.startswith("-") else whole(text)
    except ValueError as error:
        raise CorruptFile(CodedText("mesh-vertex-word", where=where, word=word[:40])) from error
    row = number - 1 if number > 0 else count + number
    if number == 0 or row < 0:
        raise CorruptFile(CodedText("mesh-vertex-number", where=where, number=number))
    return row


# -- STL


def _stl(path: Path, head: bytes) -> Corners:
    with open_regular(path) as file:
        left = os.fstat(file.fileno()).st_size - _STL_HEAD
        count = int.from_bytes(head[80:84], "little")
        # A binary file may begin with "solid" too: its length says what it is.
        if left != count * _STL_ROW.itemsize or left < 0:
            if re.match(rb"\s*solid\b", head) and b"\0" not in head:
                return _stl_text(path)
            raise CorruptFile(
                CodedText(
                    "mesh-stl-cut",
                    file=path.name,
                    triangles=count,
                    needed=count * _STL_ROW.itemsize,
                    got=max(left, 0),
                )
            )
        _refuse_many(count, path.name)
        file.seek(_STL_HEAD)
        rows = np.frombuffer(file.read(left), _STL_ROW)
    vertices = rows["corner"].reshape(-1, 3).astype(np.float64)
    return vertices, np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)


def _stl_text(path: Path) -> Corners:
    vertices = array("d")
    inside = facets = 0
    ended = False
    for number, line in _lines(path):
        words = line.split()
        key = words[0].lower() if words else ""
        where = f"{path.name}: line {number}"
        if key == "vertex":
            vertices.extend(_numbers(words[1:], 3, where))
            inside += 1
        elif key == "endfacet":
            if inside != 3:
                raise CorruptFile(CodedText("mesh-facet", where=where, inside=inside))
            inside, facets = 0, facets + 1
        elif key not in ("", "solid", "endsolid", "facet", "outer", "endloop"):
            raise CorruptFile(CodedText("mesh-stl-line", where=where, line=line[:40]))
        ended = ended and key == "" if key != "endsolid" else True
    if inside or not ended:
        raise CorruptFile(CodedText("mesh-cut", file=path.name, facets=facets))
    _refuse_many(facets, path.name)
    return _arrays(vertices, array("q", range(3 * facets)))


# -- PLY


def _ply(path: Path, head: bytes) -> Corners:
    layout = ply_layout(head, path.name)
    top = head[: head.find(b"end_header")].decode("latin1")
    elements = re.findall(r"^\s*element\s+(\w+)\s+(\d+)", top, re.MULTILINE)
    if [kind for kind, _ in elements[:2]] != ["vertex", "face"]:
        raise CorruptFile(
            CodedText(
                "mesh-elements", file=path.name, elements=str([kind for kind, _ in elements][:8])
            )
        )
    faces = whole(elements[1][1])
    _refuse_many(faces, path.name)
    table = read_cloud(path)
    if any(axis not in table for axis in "xyz"):
        raise CorruptFile(CodedText("mesh-no-xyz", file=path.name))
    vertices = np.column_stack([table[axis] for axis in "xyz"]).astype(np.float64)
    properties = _face_properties(top, path.name)
    if layout.encoding == "ascii":
        return vertices, _face_lines(path, layout.rows, faces, properties=properties)
    if len(elements) > 2:
        raise CorruptFile(CodedText("mesh-behind", file=path.name, elements=str(elements[2][0])))
    start = layout.data_at + layout.rows * layout.row_bytes
    order = "<" if "binary_little" in top else ">"
    return vertices, _face_rows(path, start, faces, row=_face_dtype(properties, order))


def _face_properties(top: str, name: str) -> list[list[str]]:
    """Words behind ``property`` of each property of a face; one of them is a list."""
    text = re.split(r"^\s*element\s+face\b.*$", top, maxsplit=1, flags=re.MULTILINE)[1]
    text = re.split(r"^\s*element\b", text, maxsplit=1, flags=re.MULTILINE)[0]
    found = [
        words.split() for words in re.findall(r"^\s*property\s+([^\r\n]+)", text, re.MULTILINE)
    ]
    for words in found:
        kinds = words[1:3] if words[0] == "list" else words[:1]
        known = len(words) >= 2 and all(
            kind in _INTEGERS or (words[0] != "list" and kind in _OTHER_BYTES) for kind in kinds
        )
        if not known or (words[0] == "list" and len(words) != 4):
            raise CorruptFile(CodedText("mesh-face-type", name=name, words=" ".join(words)[:80]))
    if len(found) > 64 or sum(words[0] == "list" for words in found) != 1:
        raise CorruptFile(CodedText("mesh-face-lists", name=name, count=len(found)))
    return found


def _face_dtype(properties: Iterable[Sequence[str]], order: str) -> np.dtype[np.void]:
    """A triangle in a binary file: its corners and whatever else a face has."""
    fields: list[Any] = []
    for words in properties:
        if words[0] == "list":
            fields.append(("n", order + _INTEGERS[words[1]]))
            fields.append(("corner", order + _INTEGERS[words[2]], (3,)))
        else:
            size = _OTHER_BYTES.get(words[0]) or np.dtype(_INTEGERS[words[0]]).itemsize
            fields.append((f"extra{len(fields)}", f"V{size}"))
    return np.dtype(fields)


def _face_rows(path: Path, start: int, count: int, *, row: np.dtype[np.void]) -> NDArray[np.int64]:
    with open_regular(path) as file:
        needed, left = count * row.itemsize, os.fstat(file.fileno()).st_size - start
        if left != needed:
            raise CorruptFile(
                CodedText("mesh-ply-cut", file=path.name, count=count, needed=needed, left=left)
            )
        file.seek(start)
        faces = np.frombuffer(file.read(needed), row, count)
    if np.any(faces["n"] != 3):
        raise CorruptFile(CodedText("mesh-triangulate", file=path.name))
    return np.asarray(faces["corner"].astype(np.int64))


def _face_lines(
    path: Path, vertices: int, count: int, *, properties: list[list[str]]
) -> NDArray[np.int64]:
    before = next(k for k, words in enumerate(properties) if words[0] == "list")
    triangles, faces = array("q"), 0
    for number, words in _behind_vertices(path, vertices):
        if faces == count:
            break
        where = f"{path.name}: line {number}"
        try:
            sides = whole(words[before])
            corners = [whole(word) for word in words[before + 1 : before + 1 + sides]]
        except (ValueError, IndexError) as error:
            raise CorruptFile(
                CodedText("mesh-face", where=where, words=" ".join(words)[:80])
            ) from error
        if len(words) != len(properties) + sides:
            raise CorruptFile(
                CodedText(
                    "mesh-face-numbers",
                    where=where,
                    sides=sides,
                    expected=len(properties) + sides,
                    got=len(words),
                )
            )
        _fan(triangles, corners, where)
        faces += 1
    if faces != count:
        raise CorruptFile(CodedText("mesh-faces-cut", file=path.name, count=count, faces=faces))
    return np.array(triangles, np.int64).reshape(-1, 3)


def _behind_vertices(path: Path, vertices: int) -> Iterator[tuple[int, list[str]]]:
    """Words of the lines behind the header and the vertices, with the lines' numbers."""
    left = -1
    for number, line in _lines(path):
        words = line.split()
        if left < 0:
            left = vertices if words[:1] == ["end_header"] else -1
        elif words and left:
            left -= 1
        elif words:
            yield number, words


# -- all of them


def _lines(path: Path) -> Iterator[tuple[int, str]]:
    return enumerate(lines_limited(path, max_bytes=MESH_FILES.max_text_bytes), start=1)


def _numbers(words: Sequence[str], count: int, where: str) -> list[float]:
    try:
        if len(words) != count or any("_" in word for word in words):
            raise ValueError(words)
        return [float(word) for word in words]
    except ValueError as error:
        raise CorruptFile(
            CodedText("mesh-numbers", where=where, count=count, words=" ".join(words)[:80])
        ) from error


def _fan(triangles: array[int], corners: Sequence[int], where: str) -> None:
    if not 3 <= len(corners) <= MESH_FILES.max_sides:
        raise CorruptFile(
            CodedText(
                "mesh-corners", where=where, max_sides=MESH_FILES.max_sides, count=len(corners)
            )
        )
    if max(corners) >= 1 << 62:
        raise CorruptFile(CodedText("mesh-vertex-numbers", where=where, corners=max(corners)))
    for b, c in pairwise(corners[1:]):
        triangles.extend((corners[0], b, c))
    _refuse_many(len(triangles) // 3, where)


def _arrays(vertices: array[float], triangles: array[int]) -> Corners:
    return (
        np.array(vertices, np.float64).reshape(-1, 3),
        np.array(triangles, np.int64).reshape(-1, 3),
    )


def _refuse_many(triangles: int, where: str) -> None:
    if triangles > MESH_FILES.max_triangles:
        raise CorruptFile(
            CodedText(
                "mesh-many",
                where=where,
                max_triangles=MESH_FILES.max_triangles,
                triangles=triangles,
            )
        )
