"""Point clouds as text: XYZ, CSV, ASC, PTS, read in blocks."""

from __future__ import annotations

import csv
import io
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.recording.formats.damaged_lines import wrong_row
from recon4.recording.limits import LIMITS
from recon4.recording.tables.coordinates import (
    AS_THE_TABLE_SAYS,
    ColumnChoice,
    TableColumns,
    TablePreview,
    preview_table,
    table_columns,
)
from recon4.recording.tables.layout import (
    TableLayout,
    is_number,
    split_row,
    with_points,
    wrong_number,
)
from recon4.recording.tables.text import table_blocks, table_head

TEXT_SUFFIXES = {".xyz", ".csv", ".txt", ".asc", ".pts", ".tsv", ".dat"}


@dataclass(frozen=True, slots=True)
class TextCloud:
    """A cloud as text, with the columns that are read."""

    path: Path
    layout: TableLayout
    columns: TableColumns

    @staticmethod
    def open(
        path: Path, choice: ColumnChoice = AS_THE_TABLE_SAYS, *, place: Array | None = None
    ) -> TextCloud:
        """Detect the columns.

        Args:
            path: The file.
            choice: What a person says of its columns.
            place: Easting and northing of the map [m], (2,), if the file is in its CRS.

        Raises:
            ConfigError: With a question, if they are not certain.
            CorruptFile: If it is no table of numbers.
        """
        layout = read_layout(path)
        return TextCloud(path, layout, table_columns(layout, choice, path.name, place=place))

    def chunks(self) -> Iterator[Array]:
        """Points in meters (or longitude, latitude in degrees and meters), (N, 3) at a time.

        Raises:
            CorruptFile: Naming the line that is no point, or if there are fewer than promised.
        """
        line, got, left = 1, 0, self.layout.head_lines
        for text in table_blocks(self.path, max_bytes=LIMITS.cloud_file_bytes):
            body = text
            while left and body:
                _, end, body = body.partition("\n")
                line, left = line + len(end), left - 1
            points = self._points(body, line)
            line, got = line + body.count("\n"), got + len(points)
            yield points * np.array(self.columns.factor)
        promised = self.layout.promised
        if promised is not None and promised != got:
            raise CorruptFile(
                CodedText("points-cut", file=self.path.name, promised=promised, got=got)
            )

    def _points(self, text: str, line: int) -> Array:
        """Numbers of a block, (N, 3)."""
        if not text.strip():
            return np.empty((0, 3))
        if max(self.columns.at) >= 3:  # behind the third, rows may have any number of cells
            self._check_widths(text, line)
        if self.layout.decimal == ",":
            text = with_points(text, self.layout.delimiter)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UserWarning)  # lines of comments only
                return np.loadtxt(
                    io.StringIO(text),
                    np.float64,
                    delimiter=self.layout.delimiter or None,
                    usecols=self.columns.at,
                    quotechar='"',
                    ndmin=2,
                ).reshape(-1, 3)
        except (ValueError, IndexError) as error:
            raise self._wrong_row(text, line) from error

    def _check_widths(self, text: str, line: int) -> None:
        """Refuse rows of another width: their columns may have moved."""
        delimiter, decimal = self.layout.delimiter, self.layout.decimal
        width = len(self.layout.rows[0])
        quoted = '"' in text
        for number, row in enumerate(text.split("\n"), start=line):
            if not row.strip() or row.lstrip().startswith("#"):
                continue
            if quoted:
                count = len(_cells(row, delimiter, decimal))
            else:
                count = row.count(delimiter) + 1 if delimiter else len(row.split())
            if count != width:
                raise CorruptFile(
                    CodedText(
                        "table-cells",
                        file=self.path.name,
                        number=number,
                        width=width,
                        count=count,
                        row=row.strip()[:80],
                    )
                )

    def _wrong_row(self, text: str, line: int) -> CorruptFile:
        """The error with the first line that is not a point."""
        name, layout = self.path.name, self.layout
        for number, row in enumerate(text.split("\n"), start=line):
            if not row.partition("#")[0].strip():
                continue
            cells = _cells(row.partition("#")[0], layout.delimiter, layout.decimal)
            found = [cells[k] if k < len(cells) else "" for k in self.columns.at]
            bad = next((cell for cell in found if not is_number(cell)), None)
            if bad is not None:
                return CorruptFile(wrong_row(name, number, row, why=wrong_number(bad)))
        return CorruptFile(CodedText("table-no-point", name=name, line=line))


def read_layout(path: Path) -> TableLayout:
    """Layout of a table, from its first lines.

    Raises:
        CorruptFile: If it is no table of numbers.
    """
    try:
        return TableLayout.of(table_head(path), path.name)
    except csv.Error as error:
        raise CorruptFile(CodedText("table-csv", file=path.name, why=str(error))) from error


def preview_cloud(
    path: Path, choice: ColumnChoice = AS_THE_TABLE_SAYS, *, place: Array | None = None
) -> TablePreview:
    """First rows of a cloud as text, and what its columns are taken for.

    Raises:
        CorruptFile: If it is no table of numbers.
    """
    return preview_table(read_layout(path), choice, place=place)


def _cells(row: str, delimiter: str, decimal: str) -> list[str]:
    try:
        return split_row(row, delimiter, decimal)
    except csv.Error:
        return []
