"""The coordinate reference system and the units that a cloud file states.

LAS: WKT record, or GeoTIFF keys (OGC 19-008r4). A key of the unit overrides the unit of the system
it stands beside: files in feet often name the system in meters (*State Plane … (Feet)*). E57 is in
meters by its standard and may state a system. PLY, PCD, OBJ, STL and text state neither.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from recon4.errors import CorruptFile
from recon4.recording.formats.e57_xml import e57_coordinate_metadata
from recon4.recording.formats.las_check import check_las
from recon4.untrusted.bounded import open_regular

_PROJECTED, _GEOGRAPHIC, _VERTICAL = 3072, 2048, 4096
_LINEAR_UNIT, _LINEAR_SIZE, _VERTICAL_UNIT = 3076, 3077, 4099
_USER_DEFINED = 32767
_EPSG_CODES = range(1024, 32767)
_UNIT_CODES = {9001: 1.0, 9002: 0.3048, 9003: 1200.0 / 3937.0}
"""EPSG code of a unit of length -> meters."""
_MAX_WKT = 256 * 1024
_WKT = 2112
_EXTENDED_AT, _EXTENDED_HEAD, _MAX_EXTENDED = 235, 60, 100
"""Extended records of LAS 1.4: place of their offset and count in the header, bytes of a head, and
how many are looked at."""


@dataclass(frozen=True, slots=True, eq=False)
class StatedCrs:
    """What a file says of its coordinates."""

    crs: Any = None
    """pyproj's CRS; None = the file states none that is known."""
    unit_m: float | None = None
    """Length of the unit of the horizontal coordinates [m]; None = not stated, or degrees."""
    height_unit_m: float | None = None
    """Length of the unit of the heights [m]; None = not stated."""
    problem: str = ""
    """Why the system is not known, if the file states one."""

    @property
    def geographic(self) -> bool:
        """Whether the horizontal coordinates are degrees."""
        return self.crs is not None and bool(_horizontal(self.crs).is_geographic)

    @property
    def name(self) -> str:
        """Name of the system with its code, for people; empty = none."""
        if self.crs is None:
            return ""
        authority = _horizontal(self.crs).to_authority(min_confidence=70)
        code = f" ({':'.join(authority)})" if authority else ""
        return f"{self.crs.name}{code}"[:120]


def stated_crs(path: Path) -> StatedCrs:
    """What a cloud file says of its coordinate reference system and units.

    Raises:
        CorruptFile: If the file is damaged.
    """
    with open_regular(path) as file:
        head = file.read(8)
    if head[:4] == b"LASF":
        return _of_las(path)
    if head == b"ASTM-E57":
        text = e57_coordinate_metadata(path)
        stated = _from_wkt(text) if text else StatedCrs()
        return StatedCrs(stated.crs, 1.0, 1.0, stated.problem)
    return StatedCrs()


def geographic_crs() -> StatedCrs:
    """Of a table whose columns are named latitude and longitude: WGS 84, heights in meters."""
    from pyproj import CRS

    return StatedCrs(CRS.from_epsg(4326), None, 1.0)


def horizontal_unit_m(crs: Any) -> float:
    """Length of the unit of a projected system [m]."""
    return float(_horizontal(crs).axis_info[0].unit_conversion_factor)


def vertical_part(crs: Any) -> Any:
    """The vertical system of a compound one; None = it has none."""
    return crs.sub_crs_list[1] if crs.is_compound else None


def horizontal_part(crs: Any) -> Any:
    """The horizontal system, without heights."""
    return _horizontal(crs).to_2d()


def _horizontal(crs: Any) -> Any:
    return crs.sub_crs_list[0] if crs.is_compound else crs


def _of_las(path: Path) -> StatedCrs:
    import laspy

    with open_regular(path) as file:
        check_las(file, path.name)
        file.seek(0)
        try:
            with laspy.open(file, laz_backend=laspy.LazBackend.Lazrs, read_evlrs=False) as las:
                records = list(las.header.vlrs.get_by_id("LASF_Projection"))
        except Exception as error:  # laspy documents no errors of damaged records
            raise CorruptFile(f"{path.name}: not sound LAS records: {error!r}"[:400]) from error
    texts = [str(getattr(r, "string", "")).strip("\0 ") for r in records if r.record_id == _WKT]
    texts += _extended_wkt(path)
    keys = _geo_keys(records)
    from_wkt = next((_from_wkt(text) for text in texts if text), None)
    if from_wkt is not None and from_wkt.crs is not None:
        return from_wkt
    if keys:
        return _from_keys(keys)
    return from_wkt or StatedCrs()


def _extended_wkt(path: Path) -> list[str]:
    """WKT records behind the points, where LAS 1.4 may have them; damaged ones are left out."""
    texts: list[str] = []
    with open_regular(path) as file:
        head = file.read(_EXTENDED_AT + 12)
        if len(head) < _EXTENDED_AT + 12 or head[25] < 4:
            return []
        at, count = struct.unpack_from("<QI", head, _EXTENDED_AT)
        for _ in range(min(count, _MAX_EXTENDED)):
            file.seek(at)
            record = file.read(_EXTENDED_HEAD)
            if len(record) < _EXTENDED_HEAD:
                break
            user, number, length = struct.unpack_from("<16sHQ", record, 2)
            if user.rstrip(b"\0") == b"LASF_Projection" and number == _WKT and length <= _MAX_WKT:
                texts.append(file.read(length).decode("utf-8", "replace").strip("\0 "))
            at += _EXTENDED_HEAD + length
            if at > path.stat().st_size:
                break
    return [text for text in texts if text]


def _geo_keys(records: list[Any]) -> dict[int, float]:
    """Values of the GeoTIFF keys that are numbers."""
    directory = next((r for r in records if r.record_id == 34735), None)
    doubles = next((r for r in records if r.record_id == 34736), None)
    values: dict[int, float] = {}
    for key in getattr(directory, "geo_keys", []):
        if key.tiff_tag_location == 0:
            values[int(key.id)] = float(key.value_offset)
        elif key.tiff_tag_location == 34736:
            found = list(getattr(doubles, "doubles", []))
            if key.value_offset < len(found):
                values[int(key.id)] = float(
                    getattr(found[key.value_offset], "value", found[key.value_offset])
                )
    return values


def _from_keys(keys: Mapping[int, float]) -> StatedCrs:
    from pyproj import CRS
    from pyproj.crs import CompoundCRS
    from pyproj.exceptions import CRSError

    code = next((int(keys[k]) for k in (_PROJECTED, _GEOGRAPHIC) if k in keys), 0)
    vertical = int(keys.get(_VERTICAL, 0))
    unit_m = _key_unit(keys, _LINEAR_UNIT, _LINEAR_SIZE) if _PROJECTED in keys else None
    height_m = _key_unit(keys, _VERTICAL_UNIT, 0)
    if code not in _EPSG_CODES:
        problem = "a system of its own (GeoTIFF keys without a code)" if code else ""
        return StatedCrs(None, unit_m, height_m, problem)
    try:
        crs = CRS.from_epsg(code)
        if vertical in _EPSG_CODES and not crs.is_compound:
            crs = CompoundCRS(f"{crs.name} + {vertical}", [crs, CRS.from_epsg(vertical)])
    except CRSError:
        return StatedCrs(None, unit_m, height_m, f"EPSG:{code}, which PROJ does not know")
    return _with_units(crs, unit_m, height_m)


def _key_unit(keys: Mapping[int, float], unit: int, size: int) -> float | None:
    code = int(keys.get(unit, 0))
    if code == _USER_DEFINED:
        return keys.get(size)
    return _UNIT_CODES.get(code)


def _from_wkt(text: str) -> StatedCrs:
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        if len(text) > _MAX_WKT:
            raise CRSError(f"{len(text)} characters")
        crs = CRS.from_user_input(text.strip().strip("\0"))
    except CRSError:
        return StatedCrs(problem=f"{text.strip()[:60]!r}, which PROJ does not know")
    return _with_units(crs, None, None)


def _with_units(crs: Any, unit_m: float | None, height_m: float | None) -> StatedCrs:
    """Units that no key states are those of the axes of the system."""
    if unit_m is None and not _horizontal(crs).is_geographic:
        unit_m = horizontal_unit_m(crs)
    if height_m is None and len(crs.axis_info) == 3:
        height_m = float(crs.axis_info[2].unit_conversion_factor)
    return StatedCrs(crs, unit_m, height_m)
