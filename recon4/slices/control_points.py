"""Control and check points: reader of survey CSV files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.errors import ConfigError, CorruptFile
from recon4.recording.tables.coordinates import AS_THE_TABLE_SAYS, ColumnChoice, TablePreview
from recon4.recording.tables.points import read_point_table
from recon4.slices.tuning_files import CONTROL_FILES

Role = Literal["control", "check"]
_ROLES: dict[str, Role] = {"control": "control", "check": "check", "": "check"}


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
    if len(data) > CONTROL_FILES.max_bytes:
        raise CorruptFile(
            f"{name}: expected at most {CONTROL_FILES.max_bytes} bytes, got {len(data)}"
        )
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
        elif len(points) >= CONTROL_FILES.max_points:
            skipped.append(f"line {row.line}: more than {CONTROL_FILES.max_points} points")
            break
        else:
            points[row.name] = ControlPoint(
                row.name, row.xyz_m, _ROLES[row.role.lower()], row.radius_m
            )
    if not points and not found.preview.question:
        raise CorruptFile(f"{name}: no line of ID,X,Y,Z found; {skipped[0] if skipped else ''}")
    skipped.sort(key=lambda text: int(text.partition(":")[0].removeprefix("line ")))
    more = len(skipped) - CONTROL_FILES.max_skipped
    return ControlPreview(
        points=tuple(points.values()),
        table=found.preview,
        skipped=(*skipped[: CONTROL_FILES.max_skipped], *[f"{more} more lines"] * (more > 0)),
    )
