"""Sizes inside LAS and LAZ files, checked before a decoder sees them.

The decoder of LAZ (lazrs, in Rust) allocates what the chunk table and the layers of a chunk ask
for. Where they lie, the allocation fails and ends the process, which no ``except`` can catch. So
this module walks the header, the variable length records, the chunk table's head and the layer
sizes of every chunk, and compares them with the size of the file.

Sources: ASPRS LAS 1.4 R15, tables 3 and 6; "LASzip specification" of rapidlasso, chunks and layers.
"""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass
from typing import BinaryIO

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText

_POINT_BYTES = {0: 20, 1: 28, 2: 26, 3: 34, 4: 57, 5: 63, 6: 30, 7: 36, 8: 38, 9: 59, 10: 67}
"""Point format -> bytes of a point without extra bytes."""
_LAYERS = {10: 9, 11: 1, 12: 2, 13: 1}
"""Item of a layered chunk -> its layers; item 14, extra bytes, has one a byte."""
_EXTRA_BYTES_14 = 14
_VLR_HEAD = 54
_MAX_ITEMS = 16
_MAX_CHUNK_POINTS = 10_000_000
_VARIABLE = 0xFFFFFFFF
_LAZ_RECORD = (b"laszip encoded", 22204)


@dataclass(frozen=True, slots=True)
class LasHeader:
    """Contents of the header."""

    points: int
    point_format: int
    point_bytes: int
    data_at: int
    """Offset of the first point, or of the pointer to the chunk table [bytes]."""
    compressed: bool


@dataclass(frozen=True, slots=True)
class _Compression:
    """The LASzip record."""

    layered: bool
    chunk_points: int
    """Points of each chunk except the last; `_VARIABLE` = as in the chunk table."""
    layers: int
    """Sizes in front of the layers of a chunk."""


def check_las(file: BinaryIO, name: str) -> LasHeader:
    """Check all sizes of a LAS or LAZ file against its length.

    Raises:
        CorruptFile: Naming what was expected and what was found.
    """
    size = os.fstat(file.fileno()).st_size
    head = _read(file, 0, min(size, 375))
    header = _header(head, size, name)
    laz = _records(file, head, header, name=name)
    if not header.compressed:
        needed = header.points * header.point_bytes
        if needed > size - header.data_at:
            raise CorruptFile(
                CodedText(
                    "las-points-cut",
                    name=name,
                    points=header.points,
                    point_bytes=header.point_bytes,
                    needed=needed,
                    size=size - header.data_at,
                )
            )
        return header
    if laz is None:
        raise CorruptFile(CodedText("laz-no-record", name=name))
    if header.points:
        _check_chunks(file, header, _compression(laz, header, name), name=name)
    return header


def _header(head: bytes, size: int, name: str) -> LasHeader:
    if len(head) < 227:
        raise CorruptFile(CodedText("las-cut", name=name, count=len(head)))
    major, minor = head[24], head[25]
    least = {0: 227, 1: 227, 2: 227, 3: 235, 4: 375}.get(minor)
    if major != 1 or least is None:
        raise CorruptFile(CodedText("las-version", name=name, major=major, minor=minor))
    header_bytes, data_at = struct.unpack_from("<HI", head, 94)
    point_id, point_bytes = struct.unpack_from("<BH", head, 104)
    points = struct.unpack_from("<Q", head, 247)[0] if minor == 4 and len(head) >= 255 else 0
    legacy = struct.unpack_from("<I", head, 107)[0]
    if minor < 4:
        points = legacy
    elif legacy not in (0, points):
        raise CorruptFile(
            CodedText("las-points-twice", name=name, points=str(points), legacy=str(legacy))
        )
    if not least <= header_bytes <= data_at <= size:
        raise CorruptFile(
            CodedText(
                "las-layout",
                name=name,
                least=least,
                size=size,
                header_bytes=str(header_bytes),
                data_at=str(data_at),
            )
        )
    point_format = point_id & 0x3F
    if point_bytes < _POINT_BYTES.get(point_format, 1 << 16):
        raise CorruptFile(
            CodedText(
                "las-point-format",
                name=name,
                point_format=str(point_format),
                point_bytes=str(point_bytes),
            )
        )
    return LasHeader(points, point_format, point_bytes, data_at, bool(point_id & 0x80))


def _records(file: BinaryIO, head: bytes, header: LasHeader, *, name: str) -> bytes | None:
    """Walk the variable length records; returns the body of LASzip's, if there is one."""
    header_bytes, count = struct.unpack_from("<H", head, 94)[0], struct.unpack_from("<I", head, 100)
    at, found = header_bytes, None
    for number in range(count[0]):
        if at + _VLR_HEAD > header.data_at:
            raise CorruptFile(
                CodedText("las-records-cut", name=name, count=str(count[0]), number=number)
            )
        record = _read(file, at, _VLR_HEAD)
        user, record_id, length = struct.unpack_from("<16sHH", record, 2)
        at += _VLR_HEAD + length
        if at > header.data_at:
            raise CorruptFile(
                CodedText(
                    "las-record-long",
                    name=name,
                    number=number,
                    length=str(length),
                    at=str(at - header.data_at),
                )
            )
        if (user.rstrip(b"\0"), record_id) == _LAZ_RECORD:
            found = _read(file, at - length, length)
    return found


def _compression(laz: bytes, header: LasHeader, name: str) -> _Compression:
    if len(laz) < 34:
        raise CorruptFile(CodedText("laz-record-short", name=name, count=len(laz)))
    compressor, coder = struct.unpack_from("<HH", laz, 0)
    chunk_points, count = struct.unpack_from("<I", laz, 12)[0], struct.unpack_from("<H", laz, 32)[0]
    if compressor not in (2, 3) or coder != 0:
        raise CorruptFile(
            CodedText("laz-compressor", name=name, compressor=str(compressor), coder=str(coder))
        )
    if not 1 <= count <= _MAX_ITEMS or len(laz) < 34 + 6 * count:
        raise CorruptFile(
            CodedText("laz-items", name=name, max_items=_MAX_ITEMS, items=str(count), size=len(laz))
        )
    items = [struct.unpack_from("<HHH", laz, 34 + 6 * k) for k in range(count)]
    if sum(size for _, size, _ in items) != header.point_bytes:
        raise CorruptFile(
            CodedText(
                "laz-items-size",
                name=name,
                point_bytes=header.point_bytes,
                items=str(sum(size for _, size, _ in items)),
            )
        )
    if chunk_points != _VARIABLE and not 1 <= chunk_points <= _MAX_CHUNK_POINTS:
        raise CorruptFile(
            CodedText(
                "laz-chunk-points",
                name=name,
                max_chunk_points=_MAX_CHUNK_POINTS,
                chunk_points=str(chunk_points),
            )
        )
    return _Compression(compressor == 3, chunk_points, _layer_count(items, compressor, name))


def _layer_count(items: list[tuple[int, int, int]], compressor: int, name: str) -> int:
    if compressor == 2:
        return 0
    unknown = [kind for kind, _, _ in items if kind not in _LAYERS and kind != _EXTRA_BYTES_14]
    if unknown:
        raise CorruptFile(CodedText("laz-layers", name=name, unknown=str(unknown)))
    return sum(size if kind == _EXTRA_BYTES_14 else _LAYERS[kind] for kind, size, _ in items)


def _check_chunks(file: BinaryIO, header: LasHeader, laz: _Compression, *, name: str) -> None:
    size = os.fstat(file.fileno()).st_size
    first = header.data_at + 8
    if size < first + 8:
        raise CorruptFile(CodedText("laz-no-chunk", name=name, points=header.points))
    table_at = struct.unpack("<q", _read(file, header.data_at, 8))[0]
    if table_at == -1:  # written to a stream: the pointer comes last
        table_at = struct.unpack("<q", _read(file, size - 8, 8))[0]
    if not first <= table_at <= size - 8:
        raise CorruptFile(
            CodedText(
                "laz-table-place", name=name, first=first, size=size - 8, table_at=str(table_at)
            )
        )
    version, chunks = struct.unpack("<II", _read(file, table_at, 8))
    expected = -(-header.points // laz.chunk_points)
    fits = chunks == expected
    if laz.chunk_points == _VARIABLE:
        fits = 1 <= chunks <= (table_at - first) // header.point_bytes + 1
    if version != 0 or not fits:
        raise CorruptFile(
            CodedText(
                "laz-table",
                name=name,
                points=header.points,
                version=str(version),
                chunks=str(chunks),
            )
        )
    # A chunk starts with one whole point, so that fewer bytes cannot be that many chunks.
    if chunks * header.point_bytes > table_at - first:
        raise CorruptFile(
            CodedText(
                "laz-chunks-many", name=name, chunks=str(chunks), table_at=str(table_at - first)
            )
        )
    if laz.layered:
        _check_layers(file, header, laz, table=(chunks, table_at), name=name)


def _check_layers(
    file: BinaryIO, header: LasHeader, laz: _Compression, *, table: tuple[int, int], name: str
) -> None:
    """Walk the chunks: first point, count of points, sizes of the layers, layers."""
    chunks, table_at = table
    at, points = header.data_at + 8, 0
    head_bytes = header.point_bytes + 4 + 4 * laz.layers
    for chunk in range(chunks):
        if at + head_bytes > table_at:
            raise CorruptFile(CodedText("laz-chunks-cut", name=name, chunks=chunks, chunk=chunk))
        head = _read(file, at, head_bytes)
        count, *layers = struct.unpack_from(f"<{1 + laz.layers}I", head, header.point_bytes)
        at += head_bytes + sum(layers)
        points += count
        if at > table_at:
            raise CorruptFile(
                CodedText("laz-layers-long", name=name, chunk=chunk, at=str(at - table_at))
            )
    if points != header.points:
        raise CorruptFile(
            CodedText("laz-points-differ", name=name, promised=header.points, got=points)
        )


def _read(file: BinaryIO, at: int, count: int) -> bytes:
    file.seek(at)
    data = file.read(count)
    if len(data) < count:
        raise CorruptFile(CodedText("las-bytes-cut", expected=count, at=at, got=len(data)))
    return data
