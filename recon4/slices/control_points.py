"""Control and check points: reader of survey CSV files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from recon4.errors import ConfigError, CorruptFile
from recon4.georeference.crs import CrsTransform, GeodeticOrigin, to_enu
from recon4.locales.coded import CodedText
from recon4.model.survey_covariance import Covariance
from recon4.recording.tables.column_names import ROLES, Role, plain_word
from recon4.recording.tables.coordinates import AS_THE_TABLE_SAYS, ColumnChoice, TablePreview
from recon4.recording.tables.points import PointTable, TablePoint, read_point_table
from recon4.slices.tuning_files import CONTROL_FILES

Lies = Literal["map", "crs", ""]


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
    covariance_m2: Covariance | None = None
    """Of survey and pick together; None = that of all points of the survey."""


@dataclass(frozen=True, slots=True)
class ControlPreview:
    """Content of a survey file, to be confirmed before it is stored."""

    points: tuple[ControlPoint, ...]
    table: TablePreview
    """Its first rows, what the columns are taken for, and the question to the operator."""
    skipped: tuple[str, ...]
    """Skipped lines, with the reason."""
    crs: str = ""
    """System into which latitude and longitude were put; empty = the file has other columns."""
    lies: Lies = ""
    """In which coordinates of the map the points lie within it; empty = in none, or not compared:
    they are in a system of their own, as a grid of the site."""


def _projected(found: PointTable, crs: str) -> tuple[tuple[TablePoint, ...], str]:
    """The rows with easting, northing and height in a system; others come back as they are."""
    if "lat" not in found.preview.columns:
        return found.points, ""
    rows = [one for one in found.points if abs(one.xyz_m[1]) <= 90.0 and abs(one.xyz_m[0]) <= 360.0]
    if len(rows) < len(found.points):
        bad = next(one for one in found.points if one not in rows)
        raise CorruptFile(
            CodedText("control-degrees", line=bad.line, lat_deg=bad.xyz_m[1], lon_deg=bad.xyz_m[0])
        )
    if not rows:
        return (), ""
    lon, lat, height = np.array([one.xyz_m for one in rows]).T
    lat, lon = np.deg2rad(lat), np.deg2rad(lon)
    place = CrsTransform(GeodeticOrigin(float(lat[0]), float(lon[0]), float(height[0])), crs)
    xyz_m = place.to_crs(to_enu(place.origin, lat, lon, ellipsoidal_height_m=height))
    return tuple(
        replace(one, xyz_m=(x, y, z)) for one, (x, y, z) in zip(rows, xyz_m.tolist(), strict=True)
    ), place.crs


def with_covariances(
    points: Sequence[ControlPoint], covariances: Mapping[str, Covariance], name: str
) -> tuple[ControlPoint, ...]:
    """Points with the covariances of a file of their own, in place of those in their rows.

    Raises:
        ConfigError: If the file names a point that the survey does not have.
    """
    unknown = [one for one in covariances if one not in {point.id for point in points}]
    if unknown:
        raise ConfigError(
            CodedText("control-not-surveyed", name=name, unknown=", ".join(unknown[:10]))
        )
    return tuple(
        replace(one, covariance_m2=covariances.get(one.id, one.covariance_m2)) for one in points
    )


def read_control(
    data: bytes,
    *,
    name: str = "file",
    choice: ColumnChoice = AS_THE_TABLE_SAYS,
    crs: str = "",
) -> ControlPreview:
    """Read a list of surveyed points, see `recon4.recording.tables`.

    Args:
        data: The file's bytes.
        name: For messages.
        choice: What a person says of the columns; without it and names the preview has a question.
        crs: System for latitude and longitude (WGS 84, ellipsoidal heights); empty = UTM.

    Raises:
        CorruptFile: If no line is a point.
        ConfigError: If the chosen columns name no place.
        GeoreferenceError: If the system is not known, or a grid of its geoid is missing.
    """
    limit = CONTROL_FILES.max_bytes
    if len(data) > limit:
        raise CorruptFile(CodedText("control-file-large", name=name, limit=limit, got=len(data)))
    found = read_point_table(data, name, choice=choice)
    rows, crs = _projected(found, crs)
    points, unused = _each_once(rows, has_names="id" in found.preview.columns)
    skipped = [*found.skipped, *unused]
    if not points and not found.preview.question:
        first = skipped[0] if skipped else ""
        raise CorruptFile(CodedText("control-no-line", name=name, first=first))
    skipped.sort(key=lambda text: int(text.partition(":")[0].removeprefix("line ")))
    more = len(skipped) - CONTROL_FILES.max_skipped
    return ControlPreview(
        points=points,
        table=found.preview,
        crs=crs,
        skipped=(*skipped[: CONTROL_FILES.max_skipped], *[f"{more} more lines"] * (more > 0)),
    )


def _each_once(
    rows: Sequence[TablePoint], *, has_names: bool
) -> tuple[tuple[ControlPoint, ...], list[str]]:
    """Points of a table, and its lines that are none, with the reason.

    Args:
        rows: Of the table.
        has_names: Whether they have names; else rows at one place are one point.
    """
    points: dict[str, ControlPoint] = {}
    at_place: dict[tuple[float, float, float], str] = {}
    unused = []
    for row in rows:
        first = row.name if has_names else at_place.setdefault(row.xyz_m, row.name)
        if first != row.name:
            unused.append(f"line {row.line}: point {first!r} is at this place already")
        elif row.name in points:
            unused.append(f"line {row.line}: point {row.name[:40]!r} is there already")
        elif (role := plain_word(row.role)) not in ROLES:
            unused.append(f"line {row.line}: expected control or check, got {row.role[:40]!r}")
        elif len(points) >= CONTROL_FILES.max_points:
            unused.append(f"line {row.line}: more than {CONTROL_FILES.max_points} points")
            break
        else:
            points[row.name] = ControlPoint(
                row.name, row.xyz_m, ROLES[role], row.radius_m, row.covariance_m2
            )
    return tuple(points.values()), unused
