"""Transformation of the local frame of a map to a coordinate reference system (A10), and back."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from recon4.errors import GeoreferenceError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText

WITHOUT_GRIDS = "without grids that are missing"
"""The best transformation that is there: enough where points surveyed in the system place the map,
as only its place on WGS 84 depends on the datum."""


@dataclass(frozen=True, slots=True)
class GeodeticOrigin:
    """Origin of a local frame (x east, y north, z up) in WGS 84."""

    lat_rad: float
    lon_rad: float
    ellipsoidal_height_m: float


def to_enu(
    origin: GeodeticOrigin, lat_rad: Array, lon_rad: Array, *, ellipsoidal_height_m: Array
) -> Array:
    """Geodetic positions in the local frame [m], (N, 3)."""
    east, north, up = _topocentric(origin).transform(
        lon_rad, lat_rad, ellipsoidal_height_m, radians=True
    )
    return np.stack([east, north, up], axis=-1)


def to_geodetic(origin: GeodeticOrigin, p_enu: Array) -> tuple[Array, Array, Array]:
    """Latitude [rad], longitude [rad] and ellipsoidal height [m] of local positions (N, 3)."""
    lon, lat, height = _topocentric(origin).transform(
        *np.asarray(p_enu, dtype=np.float64).T, direction="INVERSE", radians=True
    )
    return lat, lon, height


def default_crs(origin: GeodeticOrigin) -> str:
    """UTM zone of a position on WGS 84; heights stay ellipsoidal."""
    zone = int((np.rad2deg(origin.lon_rad) + 180.0) // 6.0) % 60 + 1
    return f"EPSG:{32600 + zone if origin.lat_rad >= 0.0 else 32700 + zone}"


class CrsTransform:
    """Transforms points of the map to a coordinate reference system.

    With a horizontal system only, heights stay ellipsoidal; with a vertical one
    (``EPSG:5514+8357``) they refer to its quasi-geoid. Easting is always first.
    """

    def __init__(self, origin: GeodeticOrigin, crs: str = "", *, operation: str = "") -> None:
        """Find the best transformation at this position.

        Args:
            origin: Origin of the map's local frame.
            crs: EPSG code or codes; empty = `default_crs`.
            operation: Description of the transformation with which the map was made, or
                `WITHOUT_GRIDS`: it may be another than the best one. Empty, or not there = the
                best one.

        Raises:
            GeoreferenceError: If there is no such system, or the transformation needs a grid that
                is not installed (PROJ would silently ignore the height).
        """
        self.origin = origin
        self.crs = code_of(crs) or default_crs(origin)
        self._target = _system(self.crs)
        self.has_heights = len(self._target.axis_info) == 3
        found = _transformers(origin, self._target)
        chosen = [
            one for one in found.transformers if operation in (WITHOUT_GRIDS, one.description)
        ]
        self.missing_grids = _missing_grids(found)
        """Files that the best transformation needs and that are not installed."""
        self._transformer = chosen[0] if chosen else _best(found, self.crs)
        here = self.to_crs(np.zeros((1, 3)))[0]
        self.storage_offset = np.round(here / 1000.0) * 1000.0
        """Multiple of 1 000 m near the origin; files subtract it to keep numbers small, (3,)."""

    @property
    def wkt(self) -> str:
        """The system as WKT 1, as LAS 1.4 requires."""
        return str(self._target.to_wkt("WKT1_GDAL"))

    @property
    def operation(self) -> str:
        """Description of the transformation by PROJ."""
        return str(self._transformer.description)

    @property
    def accuracy_m(self) -> float:
        """Stated accuracy of the transformation [m]; NaN if unknown."""
        accuracy = self._transformer.accuracy
        return float(accuracy) if accuracy >= 0.0 else float("nan")

    def to_crs(self, p_map: Array) -> Array:
        """Easting, northing, height of points of the map [m], (N, 3) -> (N, 3).

        Each point is projected, so the scale of the projection is included; about 1 us per point.
        Call it tile by tile.

        Raises:
            GeoreferenceError: If a point lies outside the area of the system.
        """
        lat, lon, height = to_geodetic(self.origin, p_map)
        if self.has_heights:
            out = self._transformer.transform(lon, lat, height, radians=True)
        else:
            out = (*self._transformer.transform(lon, lat, radians=True), height)
        p_crs = np.stack(out, axis=-1)
        if not np.isfinite(p_crs).all():
            raise GeoreferenceError(CodedText("crs-place", crs=self.crs))
        return p_crs

    def to_map(self, p_crs: Array) -> Array:
        """The inverse of `to_crs` [m], (N, 3) -> (N, 3).

        Raises:
            GeoreferenceError: If a point lies outside the area of the system.
        """
        p_crs = np.asarray(p_crs, dtype=np.float64)
        # PROJ inverts the datum shift of a horizontal system to a millimeter only.
        off = p_crs - self.to_crs(self._nearly_to_map(p_crs))
        return self._nearly_to_map(p_crs + off)

    def _nearly_to_map(self, p_crs: Array) -> Array:
        back = self._transformer.transform
        east, north, up = p_crs.T
        if self.has_heights:
            lon, lat, height = back(east, north, up, direction="INVERSE", radians=True)
        else:
            lon, lat = back(east, north, direction="INVERSE", radians=True)
            height = up
        p_map = to_enu(self.origin, lat, lon, ellipsoidal_height_m=height)
        if not np.isfinite(p_map).all():
            raise GeoreferenceError(CodedText("crs-covers", crs=self.crs))
        return p_map


def origin_near(crs: str, p_crs: Array) -> GeodeticOrigin:
    """An origin for a map at a place in a CRS, easting, northing, height [m], (3,).

    Which operation leads to WGS 84 is chosen by `CrsTransform`; any origin near the place will do.

    Raises:
        GeoreferenceError: If there is no such system, or the place is not in it.
    """
    from pyproj import Transformer

    back = Transformer.from_crs(_system(crs), "EPSG:4326", always_xy=True)
    lon, lat = back.transform(float(p_crs[0]), float(p_crs[1]))
    if not np.isfinite([lon, lat]).all():
        raise GeoreferenceError(
            CodedText("crs-coordinates", east_m=float(p_crs[0]), north_m=float(p_crs[1]), crs=crs)
        )
    # Rounded: the origin is a choice, not a measurement.
    lon, lat = round(float(lon), 6), round(float(lat), 6)
    return GeodeticOrigin(float(np.deg2rad(lat)), float(np.deg2rad(lon)), round(float(p_crs[2]), 1))


def code_of(crs: str) -> str:
    """The name of a system: a bare number is an EPSG code."""
    return f"EPSG:{crs}" if crs.isdecimal() else crs


def area_of_use(crs: str) -> tuple[float, float, float, float]:
    """West, south, east and north limit of a system [deg]; all of the earth if none is stated.

    Raises:
        GeoreferenceError: If there is no such system.
    """
    system = _system(crs)
    area = system.area_of_use or (system.sub_crs_list and system.sub_crs_list[0].area_of_use)
    return tuple(area.bounds) if area else (-180.0, -90.0, 180.0, 90.0)


def false_easting_m(crs: str) -> float:
    """Easting of the central meridian of a system [m]; 0 if it states none.

    Raises:
        GeoreferenceError: If there is no such system.
    """
    system = _system(crs)
    plane = system.sub_crs_list[0] if system.is_compound else system
    stated = plane.coordinate_operation.params if plane.coordinate_operation else ()
    return next((float(one.value) for one in stated if one.name == "False easting"), 0.0)


def _topocentric(origin: GeodeticOrigin) -> Any:
    from pyproj import Transformer

    return Transformer.from_pipeline(
        "+proj=pipeline +step +proj=cart +ellps=WGS84 +step +proj=topocentric +ellps=WGS84 "
        f"+lon_0={float(np.rad2deg(origin.lon_rad))!r} "
        f"+lat_0={float(np.rad2deg(origin.lat_rad))!r} +h_0={float(origin.ellipsoidal_height_m)!r}"
    )


def _system(name: str) -> Any:
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        system = CRS.from_user_input(code_of(name))
    except CRSError as error:
        raise GeoreferenceError(CodedText("crs-unknown", name=name)) from error
    if not (system.is_projected or (system.is_compound and system.sub_crs_list[0].is_projected)):
        raise GeoreferenceError(CodedText("crs-no-projection", name=name, system=system.name))
    if any(axis.unit_name != "metre" for axis in system.axis_info):
        raise GeoreferenceError(CodedText("crs-not-meters", name=name))
    return system


def _transformers(origin: GeodeticOrigin, target: Any) -> Any:
    """The operations that lead to a system, the best one first."""
    from pyproj.aoi import AreaOfInterest
    from pyproj.transformer import TransformerGroup

    lat, lon = float(np.rad2deg(origin.lat_rad)), float(np.rad2deg(origin.lon_rad))
    place: Any = AreaOfInterest(lon - 0.01, lat - 0.01, lon + 0.01, lat + 0.01)
    source = "EPSG:4979" if len(target.axis_info) == 3 else "EPSG:4326"
    with warnings.catch_warnings():
        # A missing grid is an error below; pyproj only warns.
        warnings.simplefilter("ignore", UserWarning)
        return TransformerGroup(
            source,
            target,
            always_xy=True,
            area_of_interest=place,
            allow_ballpark=False,
        )


def _missing_grids(found: Any) -> tuple[str, ...]:
    if found.best_available and found.transformers:
        return ()
    needed = (grid for one in found.unavailable_operations[:1] for grid in one.grids)
    return tuple(grid.short_name for grid in needed if not grid.available)


def _best(found: Any, name: str) -> Any:
    if not found.best_available or not found.transformers:
        grids = _missing_grids(found)
        if grids:
            several = ", ".join(grids)
            raise GeoreferenceError(CodedText("crs-grid", name=name, grids=several, file=grids[0]))
        raise GeoreferenceError(CodedText("crs-no-operation", name=name))
    return found.transformers[0]
