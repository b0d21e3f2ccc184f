"""Covariances of surveyed points in a file of their own, as an adjustment of a survey prints it."""

from __future__ import annotations

import csv

from recon4.errors import ConfigError, CorruptFile
from recon4.locales.coded import CodedText
from recon4.model.survey_covariance import Covariance
from recon4.recording.limits import LIMITS
from recon4.recording.tables.column_names import column_name
from recon4.recording.tables.coordinates import spread_columns
from recon4.recording.tables.layout import TableLayout, is_content, split_row
from recon4.recording.tables.points import spread_of
from recon4.recording.tables.text import decode_table, universal
from recon4.untrusted.names import check_name


def read_covariances(data: bytes, name: str) -> dict[str, Covariance]:
    """Id -> covariance of a table with ``id`` and ``sE sN sH`` or ``cEE cEN cEH cNN cNH cHH``.

    Coordinates beside them are not read. A row that is wrong refuses the file: a point would else
    have the deviation of all in silence.

    Args:
        data: The file's bytes.
        name: For messages.

    Raises:
        CorruptFile: If no line has a number, or it cannot be read as a table.
        ConfigError: If columns are missing, or a row states no covariance; with its line.
    """
    text = universal(decode_table(data, name))
    try:
        return _read(text, TableLayout.of(text, name, fewest=1), name)
    except csv.Error as error:
        raise CorruptFile(CodedText("table-csv", file=name, why=str(error))) from error


def _read(text: str, layout: TableLayout, name: str) -> dict[str, Covariance]:
    meanings = tuple(column_name(one).meaning for one in layout.names)
    spread = spread_columns(layout, meanings, own=1.0)
    if "id" not in meanings or not spread:
        raise ConfigError(
            CodedText(
                "table-spread-columns",
                name=name,
                got=", ".join(layout.names)[:80] or CodedText("no-column-names"),
            )
        )
    at, found = meanings.index("id"), dict[str, Covariance]()
    for line, row in enumerate(text.split("\n"), start=1):
        if line <= max(layout.names_line + 1, layout.head_lines) or not is_content(row):
            continue
        cells = split_row(row, layout.delimiter, layout.decimal)
        cells += [""] * (len(meanings) - len(cells))
        try:
            point = check_name(cells[at], what="the id of a point", most=LIMITS.id_characters)
            stated = spread_of([(cells[k], size) for k, size in spread])
            if stated is None or point in found:
                raise ValueError("states none" if stated is None else "is there already")
        except (ConfigError, ValueError) as error:
            raise ConfigError(
                CodedText(
                    "table-row-wrong", name=name, line=line, cells=cells[at][:40], why=str(error)
                )
            ) from error
        found[point] = stated
    return found
