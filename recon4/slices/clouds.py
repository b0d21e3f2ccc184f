"""Readers of reference clouds: PLY, PCD, LAS/LAZ, E57, XYZ/CSV, piece by piece.

Files of unknown origin: call these in a child process. lazrs asks for gigabytes when a chunk table
lies, and then the process is ended by the allocator, which no ``except`` can catch.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile, RecordingError, UnknownFormat
from recon4.geometry.se3 import Array
from recon4.recording.cloud_files import read_cloud
from recon4.slices.e57_xml import check_e57_xml

CHUNK = 1_000_000
MOST_POINTS = 400_000_000
MOST_BYTES = 20 << 30
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
    try:
        size = path.stat().st_size
        with path.open("rb") as file:
            head = file.read(64 * 1024)
    except OSError as error:
        raise RecordingError(f"{path.name} cannot be read: {error.strerror}") from error
    if size > MOST_BYTES:
        raise RecordingError(f"{path.name} has {size >> 30} GiB, at most {MOST_BYTES >> 30}")
    return head


def _checked(chunks: Iterator[Array], name: str) -> Iterator[Array]:
    count = 0
    for chunk in chunks:
        if not np.isfinite(chunk).all():
            bad = int((~np.isfinite(chunk).all(axis=1)).sum())
            raise CorruptFile(f"{name}: {bad} points have coordinates that are not numbers")
        if len(chunk) and np.abs(chunk).max() > 1e8:
            raise CorruptFile(f"{name}: coordinates beyond 100 000 km are not metres")
        count += len(chunk)
        if count > MOST_POINTS:
            raise RecordingError(f"{name} has more than {MOST_POINTS // 10**6} million points")
        yield chunk
    if not count:
        raise CorruptFile(f"{name} holds no points")


def _table(path: Path) -> Iterator[Array]:
    table = read_cloud(path)
    missing = [axis for axis in "xyz" if axis not in table]
    if missing:
        raise CorruptFile(f"{path.name}: no column {missing}; it has {sorted(table)}")
    for first in range(0, max(1, len(table["x"])), CHUNK):
        rows = slice(first, first + CHUNK)
        yield np.column_stack([table[axis][rows] for axis in "xyz"]).astype(np.float64)


def _las(path: Path) -> Iterator[Array]:
    import laspy
    import lazrs  # type: ignore[import-untyped]

    try:
        with laspy.open(path, laz_backend=laspy.LazBackend.Lazrs) as file:
            promised, got = file.header.point_count, 0
            _refuse_promise(path, promised)
            for points in file.chunk_iterator(CHUNK):
                got += len(points)
                yield np.column_stack([points.x, points.y, points.z]).astype(np.float64)
    except RecordingError:
        raise
    except (laspy.errors.LaspyException, lazrs.LazrsError, ValueError, OSError) as error:
        raise CorruptFile(f"{path.name}: not a sound LAS/LAZ file: {error}") from error
    except (MemoryError, OverflowError, KeyError, IndexError, EOFError, TypeError) as error:
        raise CorruptFile(f"{path.name}: not a sound LAS/LAZ file: {error!r}") from error
    if got != promised:
        raise CorruptFile(f"{path.name}: cut: {promised} points promised, got {got}")


def _refuse_promise(path: Path, promised: int) -> None:
    """A header that promises more than a compressed file of this size can hold."""
    most = path.stat().st_size * 40  # a LAZ point takes a byte or more; 40 is generous
    if promised > min(MOST_POINTS, most):
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
    with path.open(encoding="utf-8-sig", errors="replace") as file:
        first = file.readline()
        second = file.readline() or first
        delimiter = next((d for d in (";", "\t", ",") if d in second), None)
        comma = delimiter in (";", "\t", None) and "," in second
        file.seek(0)
        line = 0 if _is_row(first, delimiter, comma=comma) else 1
        if line:
            file.readline()
        while lines := file.readlines(32 << 20):
            text = "".join(lines)
            yield _rows(text.replace(",", ".") if comma else text, delimiter, f"{path.name}", line)
            line += len(lines)


def _is_row(text: str, delimiter: str | None, *, comma: bool) -> bool:
    try:
        values = (text.replace(",", ".") if comma else text).split(delimiter)[:3]
        return len([float(value) for value in values]) == 3
    except ValueError:
        return False


def _rows(text: str, delimiter: str | None, name: str, line: int) -> Array:
    if not text.strip():
        return np.empty((0, 3))
    try:
        return np.loadtxt(
            io.StringIO(text), np.float64, delimiter=delimiter, usecols=(0, 1, 2), ndmin=2
        )
    except (ValueError, IndexError) as error:
        raise CorruptFile(
            f"{name}, behind line {line}: expected x, y, z as numbers: {error}"
        ) from error
