"""Survey markers: tables of surveyed points, and of where they were found in the map."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from recon4.errors import CorruptFile
from recon4.evaluation.tuning import MARKER_FILES
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.recording.tables.coordinates import AS_THE_TABLE_SAYS, ColumnChoice, raise_question
from recon4.recording.tables.points import TablePoint, read_point_table
from recon4.untrusted.bounded import read_bytes_limited

Role = Literal["control", "check"]


@dataclass(frozen=True, slots=True, eq=False)
class SurveyMarker:
    """A surveyed point."""

    name: str
    xyz_m: Array
    """East, north, up (or x, y, z of the map) [m], (3,); NaN = not measured."""
    role: Role = "check"
    """Control points were used to make the map; only check points measure its accuracy."""


def read_markers(
    path: Path, *, partial: bool = False, choice: ColumnChoice = AS_THE_TABLE_SAYS
) -> tuple[SurveyMarker, ...]:
    """Read a table of markers, for example ``name``, ``x_m``, ``y_m``, ``z_m``, ``role``.

    Columns are found by their names, see `recon4.recording.tables`.

    Args:
        path: The file.
        partial: Whether coordinates may be missing: an empty cell or a dash = not measured.
        choice: What a person says of the columns.

    Raises:
        CorruptFile: Naming the line, what was expected and what was found; also if a marker is in
            two rows, alike or not: one of them would count unseen.
        ConfigError: With a question, if the columns are not certain.
    """
    data = read_bytes_limited(path, MARKER_FILES.max_bytes)
    found = read_point_table(data, path.name, choice=choice, purpose="markers", partial=partial)
    raise_question(found.preview, path.name)
    if found.skipped:
        raise CorruptFile(CodedText("markers-skipped", file=path.name, skipped=found.skipped[0]))
    lines: dict[str, int] = {}
    for row in found.points:
        if lines.setdefault(row.name, row.line) != row.line:
            raise CorruptFile(
                CodedText(
                    "markers-twice",
                    file=path.name,
                    line=row.line,
                    row=row.name[:40],
                    lines=lines[row.name],
                )
            )
    return tuple(_marker(row, f"{path.name} line {row.line}") for row in found.points)


def _marker(row: TablePoint, where: str) -> SurveyMarker:
    xyz_m = np.array(row.xyz_m)
    role = row.role or "check"
    if role not in {"control", "check"} or np.isnan(xyz_m).all():
        raise CorruptFile(
            CodedText(
                "markers-row",
                where=where,
                row=row.name[:40],
                role=role[:40],
                place=str(list(row.xyz_m)),
            )
        )
    return SurveyMarker(row.name, xyz_m, "control" if role == "control" else "check")
