"""Tables of named columns, as CSV or NPZ, read in blocks of bounded size."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import IO, Any, BinaryIO, TypeVar

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, EmptyRecording, RecordingError, UnknownFormat
from recon4.locales.coded import CodedText
from recon4.recording.clocks.stamps import strays
from recon4.recording.formats.damaged_lines import DamagedLines
from recon4.recording.report import ImportReport
from recon4.recording.samples.csv_files import csv_header, csv_number, csv_separator, csv_time
from recon4.store.arrays import ARRAY_HEADERS, DAMAGED
from recon4.untrusted.bounded import check_file_size, lines_limited, open_regular
from recon4.untrusted.limits import LIMITS

TIME = "t_ns"
"""The column of absolute times; all others are numbers."""
_BLOCK_ROWS = 1 << 16
_MAX_CSV_BYTES = 8 << 30
_MAX_NPZ_BYTES = 2 << 30
"""About ninety million rows of six columns, not compressed."""
_MAX_DIRECTORY_BYTES = 1 << 16
_END_BYTES = 22
_MAX_HEADER_BYTES = 4096
_MAX_LINE_BYTES = 16 * 1024
_HEAD_BYTES = 1 << 16

Columns = Mapping[str, NDArray[Any]]
"""Name -> values of a block: `TIME` int64, all others float64; a column without a value is NaN."""
Number = TypeVar("Number", int, float)


def column_names(path: Path) -> frozenset[str]:
    """Names of the columns of a CSV or NPZ file; empty if it is neither."""
    try:
        with open_regular(path) as file:
            if file.read(4) != b"PK\x03\x04":
                return frozenset(csv_header(path))
            with _archive(file, path.name) as archive:
                names = archive.namelist()
    except (RecordingError, *DAMAGED):
        return frozenset()
    return frozenset(name.removesuffix(".npy") for name in names if name.endswith(".npy"))


def estimate_rows(path: Path) -> int:
    """Number of rows: of an NPZ as it says, of a CSV by the length of its first lines.

    Raises:
        CorruptFile: If it is no table, or its archive is damaged.
    """
    with ExitStack() as stack:
        file = stack.enter_context(open_regular(path))
        head = file.read(_HEAD_BYTES)
        if not head.startswith(b"PK"):
            size = file.seek(0, 2)
            return round(size * max(0, head.count(b"\n") - 1) / max(1, len(head)))
        try:
            archive = stack.enter_context(_archive(file, path.name))
            return _column(archive, TIME, stack=stack, where=path.name).rows
        except DAMAGED as error:
            raise CorruptFile(
                CodedText("columns-unreadable", file=path.name, why=str(error))
            ) from error


def read_columns(
    path: Path,
    required: Sequence[str],
    optional: Sequence[str],
    *,
    report: ImportReport | None = None,
) -> Iterator[Columns]:
    """Stream the rows of a table in blocks.

    Args:
        path: CSV with a header line, or NPZ with one array a column.
        required: Columns it must have; `TIME` among them.
        optional: Columns that are NaN where the file lacks them.
        report: Gets the counts of rows, and of damaged lines of a CSV, which are dropped; None =
            not wanted.

    Raises:
        CorruptFile: If an array is damaged, or too many lines are: naming the array or the first
            line, what was expected and found.
        UnknownFormat: If a column is missing.
        EmptyRecording: If there is no row.
    """
    names = column_names(path)
    missing = [name for name in required if name not in names]
    if missing:
        lacks, needs = ", ".join(missing), ", ".join(required)
        raise UnknownFormat(
            CodedText("columns-missing", file=path.name, missing=lacks, required=needs)
        )
    wanted = [name for name in (*required, *optional) if name in names]
    absent = [name for name in optional if name not in names]
    with open_regular(path) as file:
        is_archive = file.read(2) == b"PK"
    rows = 0
    report = report or ImportReport()
    blocks = _npz_blocks(path, wanted) if is_archive else _csv_blocks(path, wanted, report)
    for block in blocks:
        apart = strays(block[TIME])
        if apart.any():
            report.count("rows_wrong_time", int(np.count_nonzero(apart)))
            block = {name: values[~apart] for name, values in block.items()}
        count = len(block[TIME])
        rows += count
        report.count("rows", count)
        yield dict(block) | {name: np.full(count, np.nan) for name in absent}
    if not rows:
        raise EmptyRecording(CodedText("columns-no-rows", file=path.name))


# -- NPZ


@dataclass(frozen=True, slots=True)
class _Column:
    """An array of an archive, open behind its header."""

    name: str
    file: IO[bytes]
    dtype: np.dtype[Any]
    rows: int


def _archive(file: BinaryIO, name: str) -> zipfile.ZipFile:
    """An archive whose directory is small.

    Raises:
        CorruptFile: If it is not, or the file is too large.
    """
    size = file.seek(0, 2)
    if size > _MAX_NPZ_BYTES:
        raise CorruptFile(
            CodedText("npz-large", name=name, max_npz_bytes=_MAX_NPZ_BYTES, size=size)
        )
    file.seek(max(0, size - (1 << 16) - _END_BYTES))
    tail = file.read()
    at = tail.rfind(b"PK\x05\x06")
    directory = int.from_bytes(tail[at + 12 : at + 16], "little") if at >= 0 else -1
    if directory < 0:
        raise CorruptFile(CodedText("npz-cut", name=name))
    if directory > _MAX_DIRECTORY_BYTES:
        most = _MAX_DIRECTORY_BYTES
        raise CorruptFile(CodedText("npz-directory", name=name, most=most, got=directory))
    file.seek(0)
    return zipfile.ZipFile(file)


def _npz_blocks(path: Path, wanted: Sequence[str]) -> Iterator[Columns]:
    with ExitStack() as stack:
        try:
            file = stack.enter_context(open_regular(path))
            archive = stack.enter_context(_archive(file, path.name))
            _check_sizes(archive, wanted, path)
            columns = [_column(archive, name, stack=stack, where=path.name) for name in wanted]
            lengths = {column.name: column.rows for column in columns}
            if len(set(lengths.values())) > 1:
                raise CorruptFile(
                    CodedText("columns-lengths", file=path.name, lengths=str(lengths))
                )
            for start in range(0, columns[0].rows, _BLOCK_ROWS):
                count = min(_BLOCK_ROWS, columns[0].rows - start)
                yield {column.name: _values(column, count, path.name) for column in columns}
        except DAMAGED as error:
            raise CorruptFile(
                CodedText("columns-unreadable", file=path.name, why=str(error))
            ) from error


def _check_sizes(archive: zipfile.ZipFile, wanted: Sequence[str], path: Path) -> None:
    size = sum(archive.getinfo(f"{name}.npy").file_size for name in wanted)
    most = max(LIMITS.free_bytes, LIMITS.expansion * path.stat().st_size)
    if size > most:
        raise CorruptFile(
            CodedText(
                "columns-expansion",
                file=path.name,
                most=most,
                expansion=LIMITS.expansion,
                size=size,
            )
        )


def _column(archive: zipfile.ZipFile, name: str, *, stack: ExitStack, where: str) -> _Column:
    info = archive.getinfo(f"{name}.npy")
    file = stack.enter_context(archive.open(info))
    version = np.lib.format.read_magic(file)
    if version not in ARRAY_HEADERS:
        raise CorruptFile(CodedText("array-version", where=where, name=name, version=str(version)))
    shape, _, dtype = ARRAY_HEADERS[version](file, max_header_size=_MAX_HEADER_BYTES)
    kinds = "iu" if name == TIME else "iuf"
    if dtype.kind not in kinds or dtype.itemsize > 8 or len(shape) != 1 or shape[0] < 0:
        what = "whole numbers" if name == TIME else "numbers"
        raise CorruptFile(
            CodedText(
                "array-shape", where=where, name=name, what=what, dtype=str(dtype), shape=str(shape)
            )
        )
    if shape[0] * dtype.itemsize > info.file_size:
        raise CorruptFile(
            CodedText(
                "array-size",
                where=where,
                name=name,
                count=shape[0],
                dtype=str(dtype),
                needed=shape[0] * dtype.itemsize,
                got=info.file_size,
            )
        )
    return _Column(name, file, dtype, int(shape[0]))


def _values(column: _Column, count: int, where: str) -> NDArray[Any]:
    data = column.file.read(count * column.dtype.itemsize)
    if len(data) != count * column.dtype.itemsize:
        raise CorruptFile(CodedText("array-cut", where=where, column=column.name, rows=column.rows))
    values = np.frombuffer(data, column.dtype)
    if column.name != TIME:
        return values.astype(np.float64)
    if np.any(values < 0) or np.any(values > np.iinfo(np.int64).max):
        raise CorruptFile(
            CodedText("column-time-range", where=where, time=TIME, values=str(values.min()))
        )
    return values.astype(np.int64)


# -- CSV


def _csv_blocks(path: Path, wanted: Sequence[str], report: ImportReport) -> Iterator[Columns]:
    with open_regular(path) as file:
        check_file_size(file, path, _MAX_CSV_BYTES)
    damaged = DamagedLines(report, "rows_damaged")
    lines = lines_limited(
        path,
        max_bytes=_MAX_CSV_BYTES,
        max_line_bytes=_MAX_LINE_BYTES,
        on_damaged=damaged.add,
    )
    separator = csv_separator(next(lines, ""))
    header = csv_header(path)
    twice = sorted({name for name in wanted if header.count(name) > 1})
    if twice:
        raise UnknownFormat(CodedText("column-twice", file=path.name, twice=str(twice)))
    numbered = ((k, line) for k, line in enumerate(lines, start=2) if line.strip(" \t\r\n;,"))
    at = {name: header.index(name) for name in wanted}
    rows = 0
    while block := list(islice(numbered, _BLOCK_ROWS)):
        cells = [line.strip("\r\n").split(separator) for _, line in block]
        table = _CsvBlock(path.name, [number for number, _ in block], cells, len(header))
        try:
            columns = table.columns(at)
        except CorruptFile:
            columns = table.sound_rows(at, damaged).columns(at)
        rows += len(columns[TIME])
        damaged.check(rows)
        yield columns
    damaged.finish(rows)


@dataclass(frozen=True, slots=True)
class _CsvBlock:
    """Some lines of a table."""

    name: str
    """Of the file."""
    numbers: list[int]
    """Of the lines."""
    cells: list[list[str]]
    width: int
    """Number of cells that a line must have."""

    def columns(self, at: Mapping[str, int]) -> Columns:
        """Values of columns by name, from their places in a line.

        Raises:
            CorruptFile: Naming the first line that is damaged.
        """
        for number, row in zip(self.numbers, self.cells, strict=True):
            if len(row) != self.width:
                raise CorruptFile(
                    CodedText(
                        "row-cells", name=self.name, number=number, width=self.width, count=len(row)
                    )
                )
        return {name: self._column(name, place) for name, place in at.items()}

    def sound_rows(self, at: Mapping[str, int], damaged: DamagedLines) -> _CsvBlock:
        """The block without its damaged lines."""
        sound = []
        for k, (number, cells) in enumerate(zip(self.numbers, self.cells, strict=True)):
            try:
                _CsvBlock(self.name, [number], [cells], self.width).columns(at)
                sound.append(k)
            except CorruptFile as error:
                damaged.add(error)
        return replace(
            self, numbers=[self.numbers[k] for k in sound], cells=[self.cells[k] for k in sound]
        )

    def _column(self, name: str, at: int) -> NDArray[Any]:
        cells = [row[at] for row in self.cells]
        if name == TIME:
            return np.array(self._each(cells, csv_time), np.int64)
        # An underscore is a digit group to Python, and a comma a decimal point to a table.
        text = "".join(cells)
        if "_" not in text and "," not in text:
            try:
                return np.array(cells).astype(np.float64)
            except ValueError:
                pass
        return np.array(self._each(cells, csv_number), np.float64)

    def _each(self, cells: list[str], parse: Callable[[str, str], Number]) -> list[Number]:
        """Parsed cell by cell, so that an error names the line."""
        return [
            parse(cell, f"{self.name}: line {number}")
            for cell, number in zip(cells, self.numbers, strict=True)
        ]
