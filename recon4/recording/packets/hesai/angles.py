"""The angles of the beams of one unit: the correction file that Hesai delivers with each sensor.

A table of text (``Channel,Elevation,Azimuth`` in degrees, one row a channel), found among the files
beside the recording. Which table belongs to which sensor follows from its number of rows, from its
elevations (two models with as many channels look in other directions) and, between several units
of one model, from the name of the file.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.recording.packets.family import Companion, PacketSensor
from recon4.recording.packets.hesai.tuning import HESAI_ANGLES


@dataclass(frozen=True, slots=True, eq=False)
class Angles:
    """Directions of the beams when the rotor is at azimuth 0."""

    elevation_rad: Array
    """Above the horizontal plane [rad], (C,)."""
    azimuth_rad: Array
    """Clockwise as seen from above [rad], (C,)."""

    def is_like(self, typical: Angles) -> bool:
        """Whether both are of one model."""
        if len(self.elevation_rad) != len(typical.elevation_rad):
            return False
        off = np.abs(self.elevation_rad - typical.elevation_rad)
        return bool(off.max() < HESAI_ANGLES.same_model_rad)


class NotAngles(ValueError):
    """The table has a bad row: says which, and why."""


def is_table(companion: Companion) -> bool:
    """Whether a file is a table of angles, sound or not."""
    return bool(_lines(companion))


def read_angles(companion: Companion) -> Angles | None:
    """The table of angles in a file; None = it is another file.

    Raises:
        NotAngles: If it is one with a damaged row, or without rows.
    """
    lines = _lines(companion)
    if not lines:
        return None
    rows = [line.split(",") for line in lines if re.match(r"\s*\d{1,3}\s*,", line)]
    if not rows:
        raise NotAngles(CodedText("hesai-angles-missing"))
    values = np.deg2rad([_row(number, row) for number, row in enumerate(rows, start=1)])
    return Angles(values[:, 0], values[:, 1])


def _lines(companion: Companion) -> list[str]:
    """The lines behind the head of a table of angles; none = it is another file."""
    try:
        lines = companion.content.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError:
        return []
    for number, line in enumerate(lines[: HESAI_ANGLES.most_head], start=1):
        cells = [cell.strip().lower() for cell in line.split(",")]
        if cells[1:3] == ["elevation", "azimuth"]:
            return lines[number:] or [""]
    return []


def _row(number: int, cells: Sequence[str]) -> tuple[float, float]:
    """Elevation and azimuth of one row [°]."""
    try:
        channel, elevation, azimuth = int(cells[0]), float(cells[1]), float(cells[2])
    except (ValueError, IndexError):
        raise NotAngles(CodedText("hesai-angles-row", number=number, cells=str(cells))) from None
    if channel != number:
        raise NotAngles(CodedText("hesai-angles-channel", number=number, channel=channel))
    most_elevation, most_azimuth = HESAI_ANGLES.limits_deg
    inside = abs(elevation) <= most_elevation and abs(azimuth) <= most_azimuth
    if not inside:
        raise NotAngles(
            CodedText("hesai-angles-number", number=number, elevation=elevation, azimuth=azimuth)
        )
    return elevation, azimuth


def angles_of(sensor: PacketSensor, channels: int, typical: Angles | None) -> Angles | None:
    """The angles of a sensor; None = no table fits, and none is typical of its model.

    What is not from a table of this unit is derived or a warning in the report.
    """
    report, name = sensor.report, sensor.sensor.name
    tables: dict[str, Angles] = {}
    for companion in sensor.companions:
        try:
            table = read_angles(companion)
        except NotAngles as error:
            report.warn(FindingKind.ANGLES_UNREADABLE, name=companion.name, error=error)
            continue
        if table is not None and len(table.elevation_rad) == channels:
            tables[companion.name] = table
    fitting = {
        key: table for key, table in tables.items() if typical is None or table.is_like(typical)
    }
    chosen = _choose(fitting, (name, sensor.sensor.model))
    if chosen is not None:
        report.derive(DerivedKind.ANGLES_FOUND, sensor=name, of="beams", source=chosen)
        return fitting[chosen]
    if typical is not None:
        report.warn(
            FindingKind.ANGLES_TYPICAL,
            sensor=name,
            model=sensor.sensor.model,
            rows=channels,
            fitting=", ".join(sorted(fitting)),
            absent=not fitting,
        )
    return typical


def _choose(tables: dict[str, Angles], words: Sequence[str]) -> str | None:
    """The only table, or the only one whose name has one of the words, in this order."""
    if len(tables) == 1:
        return next(iter(tables))
    for word in words:
        named = [key for key in tables if _plain(word) in _plain(key)]
        if len(named) == 1:
            return named[0]
    return None


def _plain(text: str) -> str:
    """Lower case, letters and digits only."""
    return re.sub(r"[^a-z0-9]", "", text.lower())
