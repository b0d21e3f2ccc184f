"""The system of a survey on earth, and which other reading of its coordinates would lie there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import reduce

import numpy as np

from recon4.errors import GeoreferenceError
from recon4.geometry.se3 import Array
from recon4.georeference.crs import (
    WITHOUT_GRIDS,
    CrsTransform,
    GeodeticOrigin,
    area_of_use,
    code_of,
    false_easting_m,
    origin_near,
    to_enu,
)
from recon4.georeference.tuning_control import SURVEY_SYSTEMS
from recon4.locales.coded import CodedText, text_of
from recon4.units import FOOT_M

_CODE = re.compile(r"EPSG:([0-9]+)")


def survey_system(crs: str, p_crs: Array, *, origin: GeodeticOrigin | None = None) -> CrsTransform:
    """The transformation of a survey at its place.

    Args:
        crs: EPSG code or codes.
        p_crs: Middle of the survey: easting, northing, height [m], (3,).
        origin: That of the map by GNSS; None = the survey alone says where it is.

    Raises:
        GeoreferenceError: If there is no such system or the survey is not there, with the reading
            of its coordinates that would be.
    """
    try:
        return _placed(crs, p_crs, origin)
    except GeoreferenceError as error:
        plan = _without_heights(crs)
        if _is_there(plan, p_crs, origin):  # only the heights have no transformation
            raise
        found = [words for words, code, p in _readings(plan, p_crs) if _is_there(code, p, origin)]
        if not found:
            raise
        words = reduce(lambda one, other: CodedText("either-or", one=one, other=other), found)
        text = CodedText("survey-reading", why=text_of(error), reading=words)
        raise GeoreferenceError(text) from error


def _placed(crs: str, p_crs: Array, origin: GeodeticOrigin | None) -> CrsTransform:
    place = origin or origin_near(crs, p_crs)
    try:
        system = CrsTransform(place, crs, operation="" if origin else WITHOUT_GRIDS)
    except GeoreferenceError as error:
        if _in_area(crs, place):
            raise
        lat_deg, lon_deg = np.rad2deg([place.lat_rad, place.lon_rad])
        raise GeoreferenceError(
            CodedText(
                "crs-not-used",
                east_m=float(p_crs[0]),
                north_m=float(p_crs[1]),
                crs=crs,
                lat_deg=float(lat_deg),
                lon_deg=float(lon_deg),
            )
        ) from error
    if origin is not None:
        off_m = float(np.linalg.norm(system.to_map(p_crs[None])))
        if off_m > SURVEY_SYSTEMS.far_m:
            raise GeoreferenceError(CodedText("crs-gnss-far", crs=crs, off_m=off_m / 1000))
    return system


def _is_there(crs: str, p_crs: Array, origin: GeodeticOrigin | None) -> bool:
    """Whether a reading of the survey lies near the map, or else in the area of its system.

    No grids are needed: datums differ by less than what counts as far.
    """
    try:
        place = origin_near(crs, p_crs)
    except GeoreferenceError:
        return False
    if origin is None:
        return _in_area(crs, place)
    lat, lon = np.array([place.lat_rad]), np.array([place.lon_rad])
    off_m = np.hypot(*to_enu(origin, lat, lon, ellipsoidal_height_m=np.zeros(1))[0, :2])
    return bool(off_m <= SURVEY_SYSTEMS.far_m)


def _without_heights(crs: str) -> str:
    """The horizontal system of a compound one: a missing geoid does not hide where points are."""
    code = _CODE.match(code_of(crs))
    return code[0] if code else crs


def _in_area(crs: str, place: GeodeticOrigin) -> bool:
    west, south, east, north = area_of_use(crs)
    lat, lon = np.rad2deg([place.lat_rad, place.lon_rad])
    return bool(west <= lon <= east and south <= lat <= north)


def _readings(crs: str, p_crs: Array) -> Iterator[tuple[str, str, Array]]:
    """Other readings of coordinates: words, system, easting, northing, height [m]."""
    exchanged = p_crs[[1, 0, 2]]
    yield CodedText("reading-exchanged"), crs, exchanged
    yield CodedText("reading-feet"), crs, p_crs * FOOT_M
    yield CodedText("reading-feet-exchanged"), crs, exchanged * FOOT_M
    million = SURVEY_SYSTEMS.zone_m
    if p_crs[0] > million:
        without = p_crs - [p_crs[0] // million * million, 0.0, 0.0]
        yield CodedText("reading-no-zone"), crs, without
    elif (zone_m := false_easting_m(crs) // million * million) > 0.0:
        number = CodedText("reading-zone", zone=round(zone_m / million))
        yield number, crs, p_crs + np.array([zone_m, 0.0, 0.0])
    code = _CODE.fullmatch(code_of(crs))
    for step in SURVEY_SYSTEMS.zones if code else ():
        other = f"EPSG:{int(code[1]) + step}" if code else crs
        yield CodedText("reading-crs", crs=other), other, p_crs
