"""Point cloud files as tables of named columns: with a header (`cloud_headers`), or by ending.

Every length is checked against the size of the file before anything is allocated: a cut file is
refused, never padded, and a large one is read piece by piece.
"""

from __future__ import annotations

import io
import os
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, UnknownFormat
from recon4.kernels.lzf import lzf_decompress
from recon4.locales.coded import CodedText
from recon4.recording.formats.bin_layout import bin_layout, is_bin
from recon4.recording.formats.cloud_headers import (
    HEADER_BYTES,
    HEADER_FORMATS,
    CloudLayout,
    header_format,
    is_ply,
)
from recon4.recording.formats.three_dtk import SCAN_SUFFIX, read_scan, scan_fields
from recon4.untrusted.bounded import open_regular
from recon4.untrusted.limits import LIMITS

Table = dict[str, NDArray[Any]]
"""Column name -> values, (N,) each."""

MAX_FRAME_BYTES = 256 << 20
"""The points of a file that is read as a whole (one revolution, or a compressed block)."""
_CHUNK_BYTES = 32 << 20
_FIRST_BYTES, _MESH_HEADER_BYTES = 16, 4096
"""What tells a PLY file, and a header with its number of faces."""
_LZF_MOST = 100
"""LZF cannot expand by more than 88: a larger claim is damage, not data."""


def is_cloud_file(path: Path) -> bool:
    """Whether the content is that of a format with a header, or plausibly of one by its ending."""
    with path.open("rb") as file:
        head = file.read(HEADER_BYTES)
    if header_format(head) is not None:
        return True
    by_ending = ending_format(path)
    return by_ending is not None and by_ending.is_of(path)


def is_plausible_cloud(path: Path) -> bool:
    """Whether a file with an ending of clouds is one: what others use, too, needs the content."""
    return path.is_file() and (ending_format(path) is None or is_cloud_file(path))


def is_mesh(path: Path) -> bool:
    """Whether the content is that of a PLY file with faces: the model of a surface, no scan."""
    if not path.is_file():
        return False
    with path.open("rb") as file:
        head = file.read(_FIRST_BYTES)
        if not is_ply(head):  # each of the thousands of clouds of a folder is asked
            return False
        head += file.read(_MESH_HEADER_BYTES)
    faces = re.search(rb"^element face (\d+)", head.split(b"end_header", 1)[0], re.MULTILINE)
    return faces is not None and int(faces[1]) > 0


def read_cloud(path: Path) -> Table:
    """Read a cloud file of at most `MAX_FRAME_BYTES`, or a format by its ending, as a whole.

    Raises:
        CorruptFile: If the bytes do not match what the header promises, or there are too many.
        UnknownFormat: If it is none of `CLOUD_FORMATS`.
    """
    by_ending = ending_format(path)
    return _read_rows(path) if by_ending is None else by_ending.read(path)


def _read_rows(path: Path) -> Table:
    with open_regular(path) as file:
        layout = _layout(file, path)
        _check_size(file, layout, path.name)
        size = layout.rows * layout.row_bytes
        if size > MAX_FRAME_BYTES:
            raise CorruptFile(
                CodedText(
                    "cloud-frame-large",
                    file=path.name,
                    max_frame_bytes=MAX_FRAME_BYTES,
                    rows=layout.rows,
                    row_bytes=layout.row_bytes,
                )
            )
        parts = list(_chunks(file, layout, path.name))
    if len(parts) == 1:
        return parts[0]
    return {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}


def cloud_chunks(path: Path) -> Iterator[Table]:
    """Read a cloud file of any size, some rows at a time.

    Raises:
        CorruptFile, UnknownFormat: As `read_cloud`.
    """
    with open_regular(path) as file:
        layout = _layout(file, path)
        _check_size(file, layout, path.name)
        yield from _chunks(file, layout, path.name)


def cloud_rows(path: Path) -> int:
    """Number of points in the header.

    Raises:
        CorruptFile, UnknownFormat: As `read_cloud`.
    """
    with open_regular(path) as file:
        return _layout(file, path).rows


def cloud_fields(path: Path) -> list[str]:
    """Names of the fields, from the header alone.

    Raises:
        CorruptFile, UnknownFormat: As `read_cloud`.
    """
    by_ending = ending_format(path)
    return list(_fields(path) if by_ending is None else by_ending.fields(path))


def _fields(path: Path) -> Iterable[str]:
    with open_regular(path) as file:
        return _layout(file, path).named()


def _is_bin(path: Path) -> bool:
    with path.open("rb") as file:
        return is_bin(file.read(HEADER_BYTES), _size(file))


@dataclass(frozen=True, slots=True)
class EndingFormat:
    """A format of frames whose files have no header: their ending says it."""

    name: str
    """For messages."""
    suffix: str
    """Of its files, in small letters."""
    is_of: Callable[[Path], bool]
    """Whether the content of a file with this ending is plausible."""
    fields: Callable[[Path], Iterable[str]]
    """Names of its columns, without reading all of it."""
    read: Callable[[Path], Table]
    """All of it. It raises `CorruptFile` if it is damaged or has more bytes than one frame may."""


ENDING_FORMATS = (
    EndingFormat("KITTI BIN", ".bin", _is_bin, _fields, _read_rows),
    EndingFormat("3DTK", SCAN_SUFFIX, Path.is_file, scan_fields, read_scan),
)
CLOUD_SUFFIXES = tuple(one.suffix for one in (*HEADER_FORMATS, *ENDING_FORMATS))
"""Of files that are frames of a folder."""
CLOUD_FORMATS = ", ".join(one.name for one in (*HEADER_FORMATS, *ENDING_FORMATS))
"""Their formats, for messages."""


def ending_format(path: Path) -> EndingFormat | None:
    """The format of an ending; None = one with a header, or none."""
    return next((one for one in ENDING_FORMATS if one.suffix == path.suffix.lower()), None)


def _layout(file: BinaryIO, path: Path) -> CloudLayout:
    head = file.read(HEADER_BYTES)
    if (known := header_format(head)) is not None:
        return known.layout(head, path.name)
    if path.suffix.lower() == ".bin":
        return bin_layout(head, _size(file), path.name)
    raise UnknownFormat(CodedText("cloud-unknown", file=path.name, formats=CLOUD_FORMATS))


def _check_size(file: BinaryIO, layout: CloudLayout, name: str) -> None:
    """Check that the file is large enough for the number of points in the header."""
    left = _size(file) - layout.data_at
    least = {"ascii": 2 * len(layout.fields), "binary": layout.row_bytes}
    needed = layout.rows * least.get(layout.encoding, 0)
    # The last line of a text may have no end.
    if left + (layout.encoding == "ascii") < needed:
        raise CorruptFile(
            CodedText(
                "cloud-cut",
                name=name,
                rows=layout.rows,
                row_bytes=layout.row_bytes,
                needed=needed,
                left=left,
            )
        )


def _chunks(file: BinaryIO, layout: CloudLayout, name: str) -> Iterator[Table]:
    if layout.encoding == "ascii":
        return _ascii(file, layout, name)
    if layout.encoding == "binary_compressed":
        return _compressed(file, layout, name)
    return _binary(file, layout, name)


# -- rows


def _binary(file: BinaryIO, layout: CloudLayout, name: str) -> Iterator[Table]:
    dtype, named = layout.row_dtype(), layout.named()
    step = max(1, _CHUNK_BYTES // layout.row_bytes)
    file.seek(layout.data_at)
    for first in range(0, max(1, layout.rows), step):
        count = min(step, layout.rows - first)
        table = np.frombuffer(_read(file, count * layout.row_bytes, name), dtype, count)
        yield {column: _native(table[f"f{k}"][:, 0]) for column, k in named.items()}


def _ascii(file: BinaryIO, layout: CloudLayout, name: str) -> Iterator[Table]:
    """Read one line per row; lines after them are ignored (PLY has faces there)."""
    file.seek(layout.data_at)
    done = 0
    while True:
        lines = _some_lines(file, layout.rows - done, name)
        if not lines and done < layout.rows:
            raise CorruptFile(CodedText("cloud-lines-cut", name=name, rows=layout.rows, done=done))
        yield _columns(lines, layout, f"{name}: behind point {done}")
        done += len(lines)
        if done == layout.rows:
            return


def _some_lines(file: BinaryIO, most: int, name: str) -> list[str]:
    """Non-empty lines, at most `_CHUNK_BYTES` in total."""
    lines: list[str] = []
    size = 0
    while len(lines) < most and size < _CHUNK_BYTES:
        line = file.readline(LIMITS.line_bytes + 1)
        if not line:
            break
        if len(line) > LIMITS.line_bytes:
            raise CorruptFile(CodedText("cloud-line-long", name=name, line_bytes=LIMITS.line_bytes))
        size += len(line)
        # Files of old Macs end their lines with \r alone.
        lines += [part for part in line.decode("latin1").splitlines() if part.strip()]
    return lines[:most]


def _columns(lines: list[str], layout: CloudLayout, where: str) -> Table:
    width = sum(field.count for field in layout.fields)
    values = np.empty((0, width))
    if lines:
        try:
            text = io.StringIO("\n".join(lines))
            values = np.loadtxt(text, np.float64, ndmin=2, comments=None)
        except ValueError as error:
            raise CorruptFile(CodedText("cloud-no-numbers", where=where, why=str(error))) from error
    if values.shape != (len(lines), width):
        raise CorruptFile(
            CodedText("cloud-line-width", where=where, width=width, shape=values.shape[1])
        )
    starts = np.cumsum([0] + [field.count for field in layout.fields])
    fields = layout.fields
    return {
        column: _cast(values[:, starts[k]], fields[k].dtype, f"{where}: {column}")
        for column, k in layout.named().items()
    }


def _cast(values: NDArray[np.float64], dtype: str, where: str) -> NDArray[Any]:
    """Convert numbers to the type of their field; checks the range of integers."""
    kind = np.dtype(dtype).newbyteorder("=")
    if kind.kind == "f":
        with np.errstate(over="ignore"):
            return values.astype(kind)
    limits = np.iinfo(kind)
    fits = (values >= limits.min) & (values <= limits.max)
    if kind.itemsize == 8:  # the limits of 64 bits are no float64
        fits &= np.abs(values) < 2.0**63
    if not np.all(fits):
        bad = values[~fits][0]
        raise CorruptFile(
            CodedText(
                "cloud-value-range", where=where, min=limits.min, max=limits.max, bad=float(bad)
            )
        )
    return values.astype(kind)


def _compressed(file: BinaryIO, layout: CloudLayout, name: str) -> Iterator[Table]:
    """Read columns stored one after the other in one compressed block."""
    expected = layout.rows * layout.row_bytes
    file.seek(layout.data_at)
    packed, unpacked = (int(v) for v in np.frombuffer(_read(file, 8, name), "<u4", 2))
    if unpacked != expected or unpacked > packed * _LZF_MOST:
        raise CorruptFile(
            CodedText(
                "cloud-unpacked-size",
                name=name,
                rows=layout.rows,
                expected=expected,
                packed=packed,
                unpacked=unpacked,
            )
        )
    if max(unpacked, packed) > MAX_FRAME_BYTES + (MAX_FRAME_BYTES >> 4):
        raise CorruptFile(
            CodedText(
                "cloud-block-large",
                name=name,
                max_frame_bytes=MAX_FRAME_BYTES,
                packed=packed,
                unpacked=unpacked,
            )
        )
    out = np.zeros(unpacked, np.uint8)
    body = np.frombuffer(_read(file, packed, name), np.uint8)
    if lzf_decompress(body, out) != unpacked:
        raise CorruptFile(CodedText("cloud-block-damaged", name=name))
    starts = np.cumsum([0] + [layout.rows * field.row_bytes for field in layout.fields])
    table = {}
    for column, k in layout.named().items():
        field = layout.fields[k]
        values = np.frombuffer(out.data, field.dtype, layout.rows * field.count, int(starts[k]))
        table[column] = _native(values.reshape(layout.rows, field.count)[:, 0])
    yield table


def _native(column: NDArray[Any]) -> NDArray[Any]:
    return np.array(column, dtype=column.dtype.newbyteorder("="))


def _read(file: BinaryIO, count: int, name: str) -> bytes:
    """Read exactly ``count`` bytes; the file is known to be large enough, or ``count`` is small."""
    left = _size(file) - file.tell()
    if left < count:
        raise CorruptFile(CodedText("cloud-promised", name=name, count=count, left=left))
    data = file.read(count)
    if len(data) < count:
        raise CorruptFile(CodedText("cloud-promised-got", name=name, expected=count, got=len(data)))
    return data


def _size(file: BinaryIO) -> int:
    return os.fstat(file.fileno()).st_size
