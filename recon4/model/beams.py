"""Corrections of the single beams of a LiDAR, and their table in a rig file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.limits import RIG_LIMITS
from recon4.model.toml_tables import TomlTable

Real = TypeVar("Real", np.float32, np.float64)
BEAMS_OF_MODEL = {
    "VLP-16": 16, "VLP-16 Hi-Res": 16, "VLP-32C": 32, "HDL-32E": 32, "HDL-64E": 64,
}  # fmt: skip
"""Of a ``generic`` LiDAR the table tells the number."""
_KEYS = ("range_m", "elevation_deg", "azimuth_deg")


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BeamCorrections:
    """What is added to the measurements of each beam; row = ring, 0 = lowest."""

    range_m: Array
    """Added to the measured range [m], (B,)."""
    elevation_rad: Array
    """Added to the elevation of the data sheet, upwards [rad], (B,)."""
    azimuth_rad: Array
    """Added to the azimuth, counterclockwise about z [rad], (B,)."""

    @staticmethod
    def of(rows: Array) -> BeamCorrections:
        """From range, elevation and azimuth, (3, B)."""
        return BeamCorrections(range_m=rows[0], elevation_rad=rows[1], azimuth_rad=rows[2])

    def __len__(self) -> int:
        return len(self.range_m)

    @property
    def rows(self) -> Array:
        """Range, elevation and azimuth, (3, B)."""
        return np.stack([self.range_m, self.elevation_rad, self.azimuth_rad])

    def apply(self, xyz: NDArray[Real], ring: NDArray[np.uint8]) -> tuple[NDArray[Real], int]:
        """Correct points in the frame of the sensor.

        Args:
            xyz: Points [m], single or double precision, (N, 3).
            ring: Beam of each, (N,).

        Returns:
            The corrected points, and the number of points whose beam has no correction.
        """
        known = ring < len(self)
        beam = np.minimum(ring, len(self) - 1)
        added_m, turn, yaw = self.rows.astype(xyz.dtype)[:, beam] * known
        x, y, z = xyz[:, 0], xyz[:, 1], xyz[:, 2]
        on_axis_m = 1e-6  # no point of a beam is nearer to the axis of rotation
        flat = np.maximum(np.hypot(x, y), xyz.dtype.type(on_axis_m))
        scale = 1.0 + added_m / np.hypot(flat, z)
        cos, sin = np.cos(turn), np.sin(turn)
        level = scale * (cos - sin * z / flat)
        cos_yaw, sin_yaw = np.cos(yaw), np.sin(yaw)
        out = np.empty_like(xyz)
        out[:, 0] = level * (x * cos_yaw - y * sin_yaw)
        out[:, 1] = level * (x * sin_yaw + y * cos_yaw)
        out[:, 2] = scale * (z * cos + flat * sin)
        return out, int(np.count_nonzero(~known))


def beam_change(
    before: BeamCorrections | None, after: BeamCorrections | None
) -> BeamCorrections | None:
    """What leads from points corrected by one table to those corrected by another; None = nothing.

    Corrections turn about the axis and in the plane of the beam, so they add up exactly.
    """
    if before is after or (before is None and after is None):
        return None
    count = max(len(table) for table in (before, after) if table is not None)
    rows = _padded(after, count) - _padded(before, count)
    return BeamCorrections.of(rows) if rows.any() else None


def _padded(table: BeamCorrections | None, count: int) -> Array:
    rows = np.zeros((3, count))
    if table is not None:
        rows[:, : len(table)] = table.rows
    return rows


def parse_beams(value: object, where: str, *, model: str) -> BeamCorrections | None:
    """Read the table ``[sensor.beams]`` of a rig file; None = there is none.

    Args:
        value: The table.
        where: File and sensor, for errors.
        model: Of the sensor; it tells the number of beams.

    Raises:
        ConfigError: Names the key, the expected and the found value.
    """
    if value is None:
        return None
    table = TomlTable.of(value, where, set(_KEYS))
    given = [key for key in _KEYS if key in table]
    if not given:
        raise ConfigError(CodedText("beams-none", where=where, known=", ".join(_KEYS)))
    first = table.get(given[0])
    count = BEAMS_OF_MODEL.get(model, len(first) if isinstance(first, list) else 0)
    if not 1 <= count <= RIG_LIMITS.beams:
        raise ConfigError(
            CodedText("beams-number", where=where, limit=RIG_LIMITS.beams, key=given[0], got=count)
        )
    limit_m, limit_deg, zeros = RIG_LIMITS.beam_m, RIG_LIMITS.beam_deg, (0.0,) * count
    range_m, *degrees = (table.vector(key, count, zeros) for key in _KEYS)
    for key, values, largest in zip(
        _KEYS,
        (range_m, *degrees),
        (limit_m, limit_deg, limit_deg),
        strict=True,
    ):
        worst = int(np.argmax(np.abs(values)))
        if abs(values[worst]) > largest:
            raise ConfigError(
                CodedText(
                    "beams-within",
                    where=where,
                    key=key,
                    limit=f"{largest:g}",
                    got=f"{values[worst]:g}",
                    beam=worst,
                )
            )
    elevation_rad, azimuth_rad = np.deg2rad(degrees)
    return BeamCorrections(range_m=range_m, elevation_rad=elevation_rad, azimuth_rad=azimuth_rad)


def format_beams(beams: BeamCorrections | None) -> list[str]:
    """Lines of a rig file, after those of the sensor; the inverse of `parse_beams`."""
    if beams is None:
        return []
    columns = (beams.range_m, np.rad2deg(beams.elevation_rad), np.rad2deg(beams.azimuth_rad))
    return [
        "[sensor.beams]",
        *(
            f"{key} = [{', '.join(repr(float(v)) for v in values)}]"
            for key, values in zip(_KEYS, columns, strict=True)
        ),
        "",
    ]
