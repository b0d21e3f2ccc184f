"""Readers of reference clouds: PLY, PCD, LAS/LAZ, E57, XYZ/CSV, piece by piece.

Files of unknown origin: call these in a child process. Sizes are checked before a decoder sees them
(`recon4.recording.formats.las_check`), but the decoders of LAZ and E57 are not ours.
"""

from __future__ import annotations

import io
import os
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.bounded import open_regular, text_blocks
from recon4.errors import CorruptFile, Recon4Error, RecordingError, UnknownFormat
from recon4.geometry.se3 import Array
from recon4.recording.formats.cloud_files import cloud_chunks, cloud_fields, cloud_rows
from recon4.recording.formats.e57_xml import check_e57_xml
from recon4.recording.formats.las_check import check_las

CHUNK = 1_000_000
MAX_POINTS = 400_000_000
MAX_BYTES = 20 << 30
_TEXT_BLOCK_BYTES = 16 << 20
TEXT_SUFFIXES = {".xyz", ".csv", ".txt", ".asc", ".pts"}


def read_points(path: Path) -> Iterator[Array]:
    """Points of a reference cloud in its own coordinates, float64 (N, 3) at a time.

    Raises:
        CorruptFile: If the bytes do not match the format, or coordinates are not finite.
        UnknownFormat: If no reader knows it.
        RecordingError: If it cannot be opened or is too large.
    """
    head = _head(path)
    if head[:4] == b"LASF":
        chunks = _las(path)
    elif head[:8] == b"ASTM-E57":
        chunks = _e57(path)
    elif head[:4] in (b"ply\n", b"ply\r") or b"\nDATA " in head:
        chunks = _table(path)
    elif path.suffix.lower() in TEXT_SUFFIXES:
        chunks = _text(path)
    else:
        raise UnknownFormat(f"{path.name}: expected a PLY, PCD, LAS, LAZ, E57, XYZ or CSV cloud")
    return _checked(chunks, path.name)


def _head(path: Path) -> bytes:
    with open_regular(path, failure=RecordingError) as file:
        size = os.fstat(file.fileno()).st_size
        head = file.read(64 * 1024)
    if size > MAX_BYTES:
        raise RecordingError(f"{path.name} has {size >> 30} GiB, at most {MAX_BYTES >> 30}")
    return head


def _checked(chunks: Iterator[Array], name: str) -> Iterator[Array]:
    count = 0
    for chunk in chunks:
        if not np.isfinite(chunk).all():
            bad = int((~np.isfinite(chunk).all(axis=1)).sum())
            raise CorruptFile(f"{name}: {bad} points have coordinates that are not numbers")
        if len(chunk) and np.abs(chunk).max() > 1e8:
            raise CorruptFile(f"{name}: coordinates beyond 100 000 km are not meters")
        count += len(chunk)
        if count > MAX_POINTS:
            raise RecordingError(f"{name} has more than {MAX_POINTS // 10**6} million points")
        yield chunk
    if not count:
        raise CorruptFile(f"{name} holds no points")


def _table(path: Path) -> Iterator[Array]:
    fields = cloud_fields(path)
    missing = [axis for axis in "xyz" if axis not in fields]
    if missing:
        raise CorruptFile(f"{path.name}: no column {missing}; it has {sorted(fields)[:20]}")
    _refuse_many(cloud_rows(path), path.name)
    for table in cloud_chunks(path):
        yield np.column_stack([table[axis] for axis in "xyz"]).astype(np.float64)


def _las(path: Path) -> Iterator[Array]:
    import laspy

    with open_regular(path) as raw:
        promised, got = check_las(raw, path.name).points, 0
        _refuse_many(promised, path.name)
        raw.seek(0)
        with (
            _decoding(path.name),
            laspy.open(raw, laz_backend=laspy.LazBackend.Lazrs, read_evlrs=False) as file,
        ):
            for points in file.chunk_iterator(CHUNK):
                got += len(points)
                yield np.column_stack([points.x, points.y, points.z]).astype(np.float64)
    if got != promised:
        raise CorruptFile(f"{path.name}: cut: {promised} points promised, got {got}")


@contextmanager
def _decoding(name: str) -> Iterator[None]:
    """Convert errors of a decoder over damaged bytes to `CorruptFile`.

    laspy and lazrs document no errors for them; a panic of Rust is no ``Exception``.
    """
    try:
        yield
    except (Recon4Error, MemoryError, GeneratorExit, KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:
        raise CorruptFile(f"{name}: not a sound LAS/LAZ file: {error!r}"[:400]) from error


def _refuse_many(points: int, name: str) -> None:
    if points > MAX_POINTS:
        raise RecordingError(f"{name}: expected at most {MAX_POINTS} points, got {points}")


def _refuse_promise(path: Path, promised: int) -> None:
    """Refuse a header with more points than a compressed file of this size can have."""
    most = path.stat().st_size * 40  # a LAZ point takes a byte or more; 40 is generous
    if promised > min(MAX_POINTS, most):
        raise CorruptFile(f"{path.name}: {promised} points promised in {path.stat().st_size} bytes")


def _e57(path: Path) -> Iterator[Array]:
    import pye57
    from pye57.libe57 import E57Exception

    check_e57_xml(path)
    try:
        file = pye57.E57(str(path))
        for index in range(file.scan_count):
            header = file.get_header(index)
            _refuse_promise(path, header.point_count)
            scan = file.read_scan(index, ignore_missing_fields=True, transform=True)
            columns = [scan[f"cartesian{axis}"] for axis in "XYZ"]
            if len(columns[0]) > header.point_count:
                raise CorruptFile(f"{path.name}: scan {index} has more points than promised")
            for first in range(0, len(columns[0]), CHUNK):
                rows = slice(first, first + CHUNK)
                yield np.column_stack([column[rows] for column in columns]).astype(np.float64)
    except CorruptFile:
        raise
    except (E57Exception, RuntimeError, ValueError, KeyError, AttributeError, OSError) as error:
        raise CorruptFile(f"{path.name}: not a sound E57 file: {error}") from error


def _text(path: Path) -> Iterator[Array]:
    """Lines of numbers, the first three columns; one head line, ``;`` and decimal comma allowed."""
    layout, line, got = None, 1, 0
    for text in text_blocks(path, block_bytes=_TEXT_BLOCK_BYTES, max_bytes=MAX_BYTES):
        if layout is None:
            layout = _TextLayout.of(text)
            if layout.has_head:
                _, _, text = text.partition("\n")
                line += 1
        rows = _rows(text, layout, path.name, line=line)
        yield rows
        got += len(rows)
        line += text.count("\n")
    if layout is not None and layout.promised not in (None, got):
        raise CorruptFile(f"{path.name}: cut: {layout.promised} points promised, got {got}")


@dataclass(frozen=True, slots=True)
class _TextLayout:
    """How the lines of a text cloud are written."""

    delimiter: str | None
    """None = blanks."""
    comma: bool
    """Decimal commas."""
    has_head: bool
    promised: int | None
    """PTS files begin with their count of points."""

    @staticmethod
    def of(text: str) -> _TextLayout:
        """Detect the format from the first lines."""
        first, _, rest = text.partition("\n")
        second = rest.partition("\n")[0] or first
        delimiter = next((d for d in (";", "\t", ",") if d in second), None)
        comma = delimiter in (";", "\t", None) and "," in second
        count = first.strip()
        promised = int(count) if re.fullmatch("[0-9]{1,12}", count) else None
        return _TextLayout(delimiter, comma, not _is_row(first, delimiter, comma=comma), promised)


def _is_row(text: str, delimiter: str | None, *, comma: bool) -> bool:
    try:
        values = (text.replace(",", ".") if comma else text).split(delimiter)[:3]
        return len([float(value) for value in values]) == 3
    except ValueError:
        return False


def _rows(text: str, layout: _TextLayout, name: str, *, line: int) -> Array:
    if layout.comma:
        text = text.replace(",", ".")
    if not text.strip():
        return np.empty((0, 3))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # lines of comments only
            return np.loadtxt(
                io.StringIO(text),
                np.float64,
                delimiter=layout.delimiter,
                usecols=(0, 1, 2),
                ndmin=2,
            ).reshape(-1, 3)
    except (ValueError, IndexError) as error:
        raise _wrong_row(text, layout, name, line=line) from error


def _wrong_row(text: str, layout: _TextLayout, name: str, *, line: int) -> CorruptFile:
    """The error with the first line that is not a point."""
    for number, row in enumerate(text.split("\n"), start=line):
        row = row.partition("#")[0].strip()
        if row and not _is_row(row, layout.delimiter, comma=False):
            return CorruptFile(
                f"{name}: line {number}: expected x, y, z as numbers, got {row[:80]!r}"
            )
    return CorruptFile(f"{name}: behind line {line}: expected x, y, z as numbers")
