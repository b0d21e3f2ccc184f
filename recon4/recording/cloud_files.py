"""Point cloud files, PCD, PLY and KITTI BIN, as tables of named columns.

Every length is checked before anything is allocated: a cut file is refused, never padded.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, UnknownFormat
from recon4.kernels.lzf import lzf_decompress

Table = dict[str, NDArray[Any]]
"""Column name -> values, (N,) each."""

_HEADER_LIMIT = 64 * 1024
_PCD_KINDS = {"F": "f", "I": "i", "U": "u"}
_PLY_TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float": "f4", "float32": "f4", "double": "f8", "float64": "f8"},
}
_PLY_ORDER = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_LZF_MOST = 100
"""LZF cannot expand by more than 88: a larger claim is damage, not data."""


@dataclass(frozen=True, slots=True)
class _Layout:
    """What a header says about the rows that follow."""

    columns: list[tuple[str, str, int]]
    """Name, dtype and count of each field; an empty name is padding."""
    rows: int
    encoding: str
    data_at: int


def is_cloud_file(path: Path) -> bool:
    """Whether the content is that of a PCD or PLY file, or plausibly of a KITTI BIN file."""
    with path.open("rb") as file:
        head = file.read(_HEADER_LIMIT)
    if _is_ply(head) or _is_pcd(head):
        return True
    return path.suffix.lower() == ".bin" and _is_bin(head, path.stat().st_size)


def read_cloud(path: Path) -> Table:
    """Read a PCD, PLY or BIN file.

    Raises:
        CorruptFile: If the bytes do not match what the header promises.
        UnknownFormat: If it is none of the three.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise CorruptFile(f"{path.name} cannot be read: {error.strerror}") from error
    if _is_ply(data):
        return _rows(data, _ply_layout(data, path.name), path.name)
    if _is_pcd(data[:_HEADER_LIMIT]):
        return _rows(data, _pcd_layout(data, path.name), path.name)
    if path.suffix.lower() == ".bin":
        return _bin(data, path.name)
    raise UnknownFormat(f"{path.name}: expected a PCD, PLY or KITTI BIN file")


def cloud_fields(path: Path) -> list[str]:
    """Names of the fields, from the header alone.

    Raises:
        CorruptFile, UnknownFormat: As `read_cloud`.
    """
    with path.open("rb") as file:
        head = file.read(_HEADER_LIMIT)
    if _is_ply(head):
        return [name for name, _, _ in _ply_layout(head, path.name).columns]
    if _is_pcd(head):
        return [name for name, _, _ in _pcd_layout(head, path.name).columns if name]
    return ["x", "y", "z", "intensity"]


def _is_ply(head: bytes) -> bool:
    return head[:4] in (b"ply\n", b"ply\r")


def _is_pcd(head: bytes) -> bool:
    return head[:1] in (b"#", b"V", b"F") and b"\nDATA " in head and b"FIELDS " in head


def _is_bin(head: bytes, size: int) -> bool:
    if size % 16 and len(head) < 1600:
        return False
    values = np.frombuffer(head[: min(len(head), 1600) // 16 * 16], "<f4")
    return bool(np.all(np.isfinite(values)) and np.all(np.abs(values) < 1e5))


# -- PCD


def _pcd_layout(data: bytes, name: str) -> _Layout:
    words: dict[str, list[str]] = {}
    at = 0
    while "DATA" not in words:
        end = data.find(b"\n", at, _HEADER_LIMIT)
        if end < 0:
            raise CorruptFile(f"{name}: the PCD header ends before its DATA line")
        line = data[at:end].decode("latin1").split("#")[0].split()
        if line:
            words[line[0]] = line[1:]
        at = end + 1
    try:
        fields, sizes, kinds = words["FIELDS"], words["SIZE"], words["TYPE"]
        counts = [int(c) for c in words.get("COUNT", ["1"] * len(fields))]
        dtypes = [_PCD_KINDS[k] + str(int(s)) for k, s in zip(kinds, sizes, strict=True)]
        columns = [
            ("" if f == "_" else f.lower(), d, c)
            for f, d, c in zip(fields, dtypes, counts, strict=True)
        ]
        grid = int(words["WIDTH"][0]) * int(words.get("HEIGHT", ["1"])[0])
        rows = int(words.get("POINTS", [str(grid)])[0])
        encoding = words["DATA"][0]
        [np.dtype(d) for d in dtypes]
    except (KeyError, ValueError, IndexError, TypeError) as error:
        raise CorruptFile(f"{name}: the PCD header makes no sense: {error!r}") from error
    if rows != grid or rows < 0 or min(counts, default=0) < 1:
        raise CorruptFile(f"{name}: PCD header: WIDTH x HEIGHT is {grid}, POINTS is {rows}")
    if encoding not in ("ascii", "binary", "binary_compressed"):
        raise CorruptFile(f"{name}: PCD DATA must be ascii, binary or binary_compressed")
    return _Layout(columns, rows, encoding, at)


# -- PLY


def _ply_layout(data: bytes, name: str) -> _Layout:
    end = data.find(b"end_header", 0, _HEADER_LIMIT)
    line_end = data.find(b"\n", end)
    if end < 0 or line_end < 0:
        raise CorruptFile(f"{name}: the PLY header does not end")
    lines = [line.split() for line in data[:end].decode("latin1").splitlines()]
    columns: list[tuple[str, str, int]] = []
    rows, element, encoding = -1, "", ""
    try:
        for line in filter(None, lines):
            if line[0] == "format":
                encoding = line[1]
            elif line[0] == "element":
                if rows < 0 and line[1] != "vertex":
                    raise CorruptFile(f"{name}: the first PLY element must be vertex: {line[1]!r}")
                element = line[1]
                rows = int(line[2]) if element == "vertex" else rows
            elif line[0] == "property" and element == "vertex":
                columns.append((line[2].lower(), _PLY_ORDER[encoding] + _PLY_TYPES[line[1]], 1))
    except (KeyError, ValueError, IndexError) as error:
        raise CorruptFile(f"{name}: the PLY header makes no sense: {error!r}") from error
    if rows < 0 or not columns or encoding not in _PLY_ORDER:
        raise CorruptFile(f"{name}: a PLY header needs a format and an element vertex")
    return _Layout(columns, rows, "ascii" if encoding == "ascii" else "binary", line_end + 1)


# -- rows


def _rows(data: bytes, layout: _Layout, name: str) -> Table:
    if layout.encoding == "ascii":
        return _ascii(data, layout, name)
    if layout.encoding == "binary_compressed":
        return _compressed(data, layout, name)
    dtype, named = _row_dtype(layout)
    needed, left = layout.rows * dtype.itemsize, len(data) - layout.data_at
    if left < needed:
        raise CorruptFile(
            f"{name}: cut: {layout.rows} points of {dtype.itemsize} bytes need {needed} bytes "
            f"behind the header, got {left}"
        )
    table = np.frombuffer(data, dtype, layout.rows, layout.data_at)
    return {column: _first(table[key]) for key, column in named.items()}


def _row_dtype(layout: _Layout) -> tuple[np.dtype[np.void], dict[str, str]]:
    """Record of one row, and its keys with the column each is."""
    fields: list[tuple[str, str, tuple[int]]] = []
    named: dict[str, str] = {}
    for k, (column, dtype, count) in enumerate(layout.columns):
        fields.append((f"f{k}", dtype if dtype[0] in "<>" else f"<{dtype}", (count,)))
        if column and column not in named.values():
            named[f"f{k}"] = column
    return np.dtype(fields), named


def _first(column: NDArray[Any]) -> NDArray[Any]:
    return np.ascontiguousarray(column[:, 0]).astype(column.dtype.newbyteorder("="))


def _ascii(data: bytes, layout: _Layout, name: str) -> Table:
    width = sum(count for _, _, count in layout.columns)
    lines = data[layout.data_at :].decode("latin1").splitlines()
    rows = [line for line in lines if line.strip()][: layout.rows]
    if len(rows) < layout.rows:
        raise CorruptFile(f"{name}: cut: {layout.rows} points promised, got {len(rows)} lines")
    try:
        values = np.loadtxt(io.StringIO("\n".join(rows)), np.float64, ndmin=2) if rows else None
    except ValueError as error:
        raise CorruptFile(f"{name}: not a table of numbers: {error}") from error
    if values is None:
        values = np.empty((0, width))
    if values.shape[1] != width:
        raise CorruptFile(f"{name}: {width} numbers a line expected, got {values.shape[1]}")
    starts = np.cumsum([0] + [count for _, _, count in layout.columns])
    return {
        column: values[:, start].astype(dtype.lstrip("<>"))
        for (column, dtype, _), start in zip(layout.columns, starts, strict=False)
        if column
    }


def _compressed(data: bytes, layout: _Layout, name: str) -> Table:
    """Columns one behind the other, compressed as one block."""
    sizes = [np.dtype(dtype).itemsize * count for _, dtype, count in layout.columns]
    body = data[layout.data_at :]
    if len(body) < 8:
        raise CorruptFile(f"{name}: cut inside the sizes of the compressed block")
    packed, unpacked = (int(v) for v in np.frombuffer(body, "<u4", 2))
    if unpacked != layout.rows * sum(sizes) or unpacked > packed * _LZF_MOST:
        raise CorruptFile(
            f"{name}: {layout.rows} points are {layout.rows * sum(sizes)} bytes, "
            f"the compressed block says {unpacked}"
        )
    if len(body) - 8 < packed:
        raise CorruptFile(f"{name}: cut: {packed} compressed bytes promised, got {len(body) - 8}")
    out = np.zeros(unpacked, np.uint8)
    if lzf_decompress(np.frombuffer(body, np.uint8, packed, 8), out) != unpacked:
        raise CorruptFile(f"{name}: the compressed block is damaged")
    table, at = {}, 0
    for (column, dtype, count), size in zip(layout.columns, sizes, strict=True):
        if column:
            values = np.frombuffer(out.data, f"<{dtype}", layout.rows * count, at)
            table[column] = values.reshape(layout.rows, count)[:, 0].copy()
        at += layout.rows * size
    return table


def _bin(data: bytes, name: str) -> Table:
    if len(data) % 16:
        raise CorruptFile(
            f"{name}: a KITTI BIN file has 16 bytes a point (x y z intensity as float32), "
            f"got {len(data)} bytes, {len(data) % 16} too many"
        )
    values = np.frombuffer(data, "<f4").reshape(-1, 4)
    return {key: values[:, k].copy() for k, key in enumerate(("x", "y", "z", "intensity"))}
