"""What ``tiles.json`` says of a whole map, besides its tiles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, text_of
from recon4.store.json_files import read_object
from recon4.untrusted.limits import LIMITS


@dataclass(frozen=True, slots=True)
class MapCrs:
    """Coordinate reference system of the map."""

    wkt: str
    """The CRS as WKT."""
    origin_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Coordinates of the map's origin in it [m]; the axes are parallel."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapNotes:
    """How a map was made; the fields are keys of ``tiles.json``."""

    voxel_m: float = 0.0
    """Edge of the cubes that keep one point [m]; 0 = not thinned."""
    crs: MapCrs | None = None
    sensors: tuple[str, ...] = ()
    """Names of the sensors, in the order of their numbers in the points."""
    removed: Mapping[str, int] = field(default_factory=dict)
    """Reason -> number of points that are not in the map."""
    classes: Mapping[int, int] = field(default_factory=dict)
    """Code of a class -> number of its points, also of those that are left out; empty = it was not
    counted."""
    corrected: tuple[int, ...] = ()
    """Points that each correction of classes changed; empty = there are none."""

    @staticmethod
    def of(facts: Mapping[str, Any]) -> MapNotes:
        """Read them from a parsed ``tiles.json``.

        Raises:
            KeyError, TypeError, ValueError: If they are not as written.
        """
        crs = facts["crs"]
        return MapNotes(
            voxel_m=float(facts.get("voxel_m") or 0.0),
            crs=MapCrs(crs["wkt"], tuple(crs["origin_m"])) if crs else None,
            sensors=tuple(str(name) for name in facts.get("sensors", ())),
            removed={str(name): int(n) for name, n in facts.get("removed", {}).items()},
            classes={int(code): int(n) for code, n in facts.get("classes", {}).items()},
            corrected=tuple(int(n) for n in facts.get("corrected", ())),
        )

    def to_json(self) -> dict[str, object]:
        """Entries of ``tiles.json``."""
        crs = self.crs and {"wkt": self.crs.wkt, "origin_m": list(self.crs.origin_m)}
        record: dict[str, object] = {
            "voxel_m": self.voxel_m,
            "crs": crs,
            "sensors": list(self.sensors),
            "removed": dict(self.removed),
            "classes": {str(code): n for code, n in sorted(self.classes.items())},
        }
        return record | ({"corrected": list(self.corrected)} if self.corrected else {})


def read_map_list(path: Path) -> dict[str, Any]:
    """Parse a ``tiles.json``.

    Raises:
        StoreError: If it is missing or damaged.
    """
    try:
        return read_object(path, max_bytes=LIMITS.tile_list_bytes)
    except StoreError as error:
        raise StoreError(CodedText("map-list", file=str(path), why=text_of(error))) from error
