"""The map as LAZ 1.4.

lazrs keeps a pool of threads that does not survive a fork: a worker process that writes LAZ must be
spawned.
"""

from __future__ import annotations

import io
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import chain, groupby, pairwise
from pathlib import Path
from typing import Any

import laspy
import lazrs
import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError, StoreError
from recon4.export.account import PointAccount
from recon4.export.las_points import (
    add_records,
    crs_text,
    las_blocks,
    las_header,
    las_points,
    las_records,
    value_records,
    values_header,
)
from recon4.export.names import check_name
from recon4.export.points import CRS_OF_MAP, Block, OutputCrs, PointSource
from recon4.export.selection import DELIVERED, PointSelection
from recon4.export.tuning import LAZ, POINT_EXPORT, REREAD
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.mapping.threads import Each, InThreads
from recon4.mapping.tiles import TileSet
from recon4.progress import Progress, Silent
from recon4.store.atomic import atomic_file


class ErrorKeepingWriter(io.BufferedWriter):
    """Keeps the error of a failed write, because lazrs does not report it."""

    write_error: OSError | None = None

    def __init__(self, raw: io.FileIO) -> None:
        super().__init__(raw)
        self.written: dict[int, tuple[int, int]] = {}
        """First byte of each write -> how many bytes, and their CRC-32."""

    def write(self, data: Any) -> int:
        at = self.tell()
        try:
            count = super().write(data)
        except OSError as error:
            self.write_error = error
            raise
        if count:
            self.written[at] = count, zlib.crc32(data)
        return count


@contextmanager
def writing_las(path: Path, name: str) -> Iterator[ErrorKeepingWriter]:
    """A file that LAZ is written to.

    Raises:
        OSError: If it cannot be written.
        StoreError: If the points cannot be compressed.
    """
    with ErrorKeepingWriter(io.FileIO(path, "wb")) as file:
        try:
            yield file
            file.flush()
        except (laspy.errors.LaspyException, lazrs.LazrsError) as error:
            if file.write_error:
                raise file.write_error from error
            raise StoreError(CodedText("cannot-write", name=name, why=str(error))) from error


@contextmanager
def reading_las(name: str) -> Iterator[None]:
    """Report errors of reading a file again.

    Raises:
        StoreError: If it is none.
    """
    try:
        yield
    except (laspy.errors.LaspyException, lazrs.LazrsError, ValueError) as error:
        raise StoreError(CodedText("reread-why", name=name, why=str(error))) from error


def export_laz(
    map_: Path | TileSet,
    path: Path,
    output: OutputCrs = CRS_OF_MAP,
    *,
    selection: PointSelection = DELIVERED,
    progress: Progress | None = None,
) -> int:
    """Write a map as LAZ, streaming, and check the file before it gets its name.

    Intensity is the raw one; ``ring``, ``frame_id`` and those of `OPTIONAL` are extra bytes,
    the point source is the sensor's row + 1, the return number is 2 for a further echo. Times
    are adjusted standard GPS time, or seconds of the recording's clock if that is not UTC.

    Args:
        map_: Artifact of the stage ``map``, or what is open of it.
        path: File to write, ``.laz``.
        output: CRS of the file.
        selection: Which points are written.
        progress: Who watches.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If there are no points, or the name is not one of a LAZ file.
        GeoreferenceError: If the CRS is not understood, or coordinates do not fit.
        StoreError: If the file cannot be written or does not read back (`NoSpace`: disk full).
    """
    check_name(path, ".laz")
    watch = progress or Silent()
    source = PointSource.of(map_, output, selection, progress=watch)
    return _export(source, path, watch, whole=True)


def export_map_laz(
    map_: Path | TileSet, path: Path, output: OutputCrs, *, progress: Progress | None = None
) -> int:
    """Write a map as `export_laz` does, with the same bytes, but expand a part of it only.

    All bytes are read back and compared with what the compression gave. The first chunk of each
    `LAZ.together` points is expanded and compared with what was meant.
    """
    check_name(path, ".laz")
    source = PointSource.of(map_, output)
    return _export(source, path, progress or Silent(), whole=False)


def _export(source: PointSource, path: Path, progress: Progress, *, whole: bool) -> int:
    """Write and check a file; ``whole`` = all of its points are expanded again."""
    with ThreadPoolExecutor(LAZ.workers) as pool, atomic_file(path) as temporary:
        each = InThreads(pool)
        source = replace(source, each=each)
        header = las_header(source, scale_m=LAZ.scale_m)
        meant = PointAccount(crs=crs_text(header))
        stream = las_blocks(source, progress)
        with writing_las(temporary, path.name) as file:
            for points in _written(file, header, _together(stream, header, meant, each=each)):
                meant.add_stored(points if whole else points[: POINT_EXPORT.summed], each)
        if not whole:
            _check_bytes(temporary, file.written, path.name)
        source.seal(temporary)
        with reading_las(path.name):
            _check(temporary, meant, path.name, each=each if whole else None, progress=progress)
    return meant.count


def _written(
    file: ErrorKeepingWriter, header: Any, batches: Iterable[Any]
) -> Iterator[NDArray[np.void]]:
    """Compress batches of points; the records of each when they are."""
    with laspy.open(
        file,
        mode="w",
        header=header,
        laz_backend=laspy.LazBackend.LazrsParallel,
        closefd=False,
    ) as out:
        for points in batches:
            out.write_points(points)
            yield points.array


@dataclass(frozen=True, slots=True, eq=False)
class _BatchPart:
    """Points of a file that are made ready at once."""

    block: Block
    first: int
    """Number of the first in the file."""

    @property
    def batch(self) -> int:
        """Which points it is compressed with."""
        return self.first // LAZ.together


def _parts(stream: Iterable[Block]) -> Iterator[_BatchPart]:
    """Blocks, cut where a batch ends: batches are as large as can be, and so are chunks."""
    first = 0
    for block in stream:
        count = len(block.xyz)
        ends = range(LAZ.together - first % LAZ.together, count, LAZ.together)
        for begin, end in pairwise([0, *ends, count]):
            part = block if end - begin == count else block.only(slice(begin, end))
            yield _BatchPart(part, first + begin)
        first += count


def _together(
    stream: Iterable[Block], header: Any, meant: PointAccount, *, each: Each
) -> Iterator[Any]:
    """Records of many blocks at a time, of which each thread compresses a part.

    They are valid until the next ones.
    """
    records = las_records(LAZ.together, header)

    def fill(part: _BatchPart) -> PointAccount:
        begin, account = part.first % LAZ.together, PointAccount()
        rows = slice(begin, begin + len(part.block.xyz))
        las_points(part.block, header, records[rows], account=account)
        return account

    for batch, parts in groupby(_parts(stream), lambda part: part.batch):
        for account in each(fill, parts):
            meant.merge(account)
        yield laspy.ScaleAwarePointRecord(
            records[: meant.count - batch * LAZ.together],
            header.point_format,
            header.scales,
            header.offsets,
        )


def _check_bytes(path: Path, written: Mapping[int, tuple[int, int]], name: str) -> None:
    """Read the bytes of a file back, and compare them with those that were written.

    Raises:
        StoreError: If they differ.
    """
    at = 0
    with path.open("rb") as file:
        for first, (count, crc) in sorted(written.items()):
            if first != at or zlib.crc32(file.read(count)) != crc:
                raise StoreError(CodedText("reread-bytes", name=name, count=count, first=first))
            at += count
        if file.read(1):
            raise StoreError(CodedText("reread-longer", name=name, at=at))


def _check(
    path: Path, meant: PointAccount, name: str, *, each: Each | None, progress: Progress
) -> None:
    """Read points back, and compare with what was meant.

    Args:
        path: The file.
        meant: What it shall hold.
        name: Of the file, for errors.
        each: Threads for all points; None = the first ones of each batch, to which the checksums
            belong.
        progress: Counts the points that were compared.

    Raises:
        StoreError: If the file differs.
    """
    with laspy.open(path) as file:
        stated = PointAccount(crs_text(file.header), file.header.point_count)
        stated.low_m, stated.high_m = file.header.mins, file.header.maxs
        if each is None:
            stated.classes, stated.sums = meant.classes, meant.sums
            found = stated
            _check_first(file, meant.sums, name)
        else:
            found = _account_of_all(file, each, progress)
            stated.classes, stated.sums = found.classes, found.sums
    rounded_m = LAZ.scale_m / 2.0 + REREAD.bounds_m
    for one in (stated, found):
        meant.compare(one, name, within_m=rounded_m)


def _check_first(file: Any, sums: Sequence[int], name: str) -> None:
    """Compare the first points of each batch with their checksums.

    Raises:
        StoreError: If they differ.
    """
    for batch, expected in enumerate(sums):
        first, read = batch * LAZ.together, PointAccount()
        file.seek(first)
        read.add_stored(file.read_points(POINT_EXPORT.summed).array)
        if read.sums != [expected]:
            raise StoreError(CodedText("reread-from", name=name, first=first))


def _account_of_all(file: Any, each: Each, progress: Progress) -> PointAccount:
    """Account for all points of a file."""
    found = PointAccount(crs=crs_text(file.header))
    progress.start("compare", file.header.point_count, "points")
    for points in file.chunk_iterator(LAZ.together):
        _account(found, points.array, file.header, each=each)
        progress.advance(len(points))
    return found


def _account(found: PointAccount, records: NDArray[np.void], header: Any, *, each: Each) -> None:
    """Account for records that were read, (N,), some of them on each thread."""

    def account(first: int) -> PointAccount:
        part = PointAccount()
        add_records(part, records[first : first + POINT_EXPORT.summed], header)
        return part

    for part in each(account, range(0, len(records), POINT_EXPORT.summed)):
        found.merge(part)
    found.add_stored(records, each)


@dataclass(frozen=True, slots=True, eq=False)
class ValuePoints:
    """Points with values of their own."""

    xyz: Array
    """Coordinates of the file [m], (N, 3)."""
    values: Mapping[str, NDArray[Any]]
    """Name of an extra dimension -> its values, (N,); the same names and types in all parts."""


def write_values(
    parts: Iterable[ValuePoints], path: Path, *, crs: str, offset_m: NDArray[np.float64]
) -> int:
    """Write points with values as LAZ 1.4, streaming.

    Args:
        parts: The points.
        path: File to write, ``.laz``.
        crs: WKT or code of the CRS; empty = a local frame.
        offset_m: Of the coordinates in the file, whole meters, (3,).

    Returns:
        How many points were written.

    Raises:
        ConfigError: If there are no points, or the name is not one of a LAZ file.
        GeoreferenceError: If the CRS is not understood.
        StoreError: If the file cannot be written or does not read back (`NoSpace`: disk full).
    """
    check_name(path, ".laz")
    stream = iter(parts)
    first = next((part for part in stream if len(part.xyz)), None)
    if first is None:
        raise ConfigError(CodedText("export-no-points"))
    header = values_header(
        {name: values.dtype.str[1:] for name, values in first.values.items()}, crs, offset_m
    )
    count = 0
    with atomic_file(path) as temporary:
        with (
            writing_las(temporary, path.name) as file,
            laspy.open(
                file,
                mode="w",
                header=header,
                laz_backend=laspy.LazBackend.LazrsParallel,
                closefd=False,
            ) as out,
        ):
            for part in chain([first], stream):
                out.write_points(value_records(header, part.xyz, part.values))
                count += len(part.xyz)
        with reading_las(path.name), laspy.open(temporary) as written:
            if sum(len(points) for points in written.chunk_iterator(LAZ.together)) != count:
                raise StoreError(CodedText("reread-count", file=path.name, count=count))
    return count
