"""Control and check points: reader of survey CSV files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.errors import ConfigError, CorruptFile
from recon4.recording.tables.coordinates import AS_THE_TABLE_SAYS, ColumnChoice, TablePreview
from recon4.recording.tables.points import read_point_table

Role = Literal["control", "check"]
MAX_POINTS = 5000
MAX_BYTES = 4 << 20
_ROLES: dict[str, Role] = {"control": "control", "check": "check", "": "check"}
_MAX_SKIPPED = 100
"""Largest number of skipped lines listed individually."""


@dataclass(frozen=True, slots=True)
class ControlPoint:
    """A surveyed point."""

    id: str
    xyz_m: tuple[float, float, float]
    """Easting (or x), northing (or y), height [m]."""
    role: Role = "check"
    """Control points were used to make the map; only check points measure its accuracy."""
    radius_m: float = 0.0
    """Radius of a spherical target [m]."""


@dataclass(frozen=True, slots=True)
class ControlPreview:
    """Content of a survey file, to be confirmed before it is stored."""

    points: tuple[ControlPoint, ...]
    table: TablePreview
    """Its first rows, what the columns are taken for, and the question to the operator."""
    skipped: tuple[str, ...]
    """Skipped lines, with the reason."""


def read_control(
    data: bytes, *, name: str = "file", choice: ColumnChoice = AS_THE_TABLE_SAYS
) -> ControlPreview:
    """Read a list of surveyed points, see `recon4.recording.tables`.

    Args:
        data: The file's bytes.
        name: For messages.
        choice: What a person says of the columns; without it and without names of east and north
            the preview has a question.

    Raises:
        CorruptFile: If no line is a point.
        ConfigError: If the chosen columns name no place.
    """
    if len(data) > MAX_BYTES:
        raise CorruptFile(f"{name}: expected at most {MAX_BYTES} bytes, got {len(data)}")
    found = read_point_table(data, name, choice=choice)
    if "lat" in found.preview.columns:
        raise ConfigError(
            f"{name}: expected meters of a map projection, got latitude and longitude"
        )
    points: dict[str, ControlPoint] = {}
    skipped = [*found.skipped]
    for row in found.points:
        if row.name in points:
            skipped.append(f"line {row.line}: point {row.name[:40]!r} is there already")
        elif row.role.lower() not in _ROLES:
            skipped.append(f"line {row.line}: expected control or check, got {row.role[:40]!r}")
        elif len(points) >= MAX_POINTS:
            skipped.append(f"line {row.line}: more than {MAX_POINTS} points")
            break
        else:
            points[row.name] = ControlPoint(
                row.name, row.xyz_m, _ROLES[row.role.lower()], row.radius_m
            )
    if not points and not found.preview.question:
        raise CorruptFile(f"{name}: no line of ID,X,Y,Z found; {skipped[0] if skipped else ''}")
    skipped.sort(key=lambda text: int(text.partition(":")[0].removeprefix("line ")))
    more = len(skipped) - _MAX_SKIPPED
    return ControlPreview(
        points=tuple(points.values()),
        table=found.preview,
        skipped=(*skipped[:_MAX_SKIPPED], *[f"{more} more lines"] * (more > 0)),
    )
