"""Geometries of GeoJSON at places of a map."""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np

from recon4.geometry.se3 import Array
from recon4.georeference.crs import CrsTransform, to_geodetic
from recon4.georeference.geojson_crs import geojson_crs
from recon4.georeference.site_grid import SiteGrid

MapSystem = CrsTransform | SiteGrid
"""Where a map has its coordinates."""
JsonObject = dict[str, object]


def feature(p_map: Array, place: MapSystem | None, about: JsonObject) -> JsonObject:
    """A feature at a point or along a line.

    Args:
        p_map: Its positions in the map [m], (N, 3); none = it has no geometry.
        place: Where the map is; None = not georeferenced.
        about: Its properties; ``coordinates`` is added.
    """
    return {
        "type": "Feature",
        "geometry": _geometry(p_map, place),
        "properties": about | {"coordinates": _frame(place)},
    }


def collection(features: Sequence[JsonObject], place: MapSystem | None) -> str:
    """Features as a file, which names its system unless it has longitudes and latitudes.

    Args:
        features: As `feature` makes them.
        place: Where the map is, as given to `feature`.
    """
    whole: JsonObject = {"type": "FeatureCollection"}
    if not isinstance(place, CrsTransform):
        whole["crs"] = geojson_crs(wkt=place.wkt if place is not None else "")
    whole["features"] = list(features)
    return json.dumps(whole, ensure_ascii=False, indent=1) + "\n"


def _frame(place: MapSystem | None) -> str:
    if isinstance(place, CrsTransform):
        return "WGS 84: longitude, latitude [deg], ellipsoidal height [m]"
    if place is not None:
        return "grid of the site: easting, northing, height [m]"
    return "map frame: x, y, z [m]; the map is not georeferenced"


def _geometry(line: Array, place: MapSystem | None) -> JsonObject | None:
    if not len(line):
        return None
    p = line
    if isinstance(place, SiteGrid):
        p = place.to_crs(line)
    elif place is not None:
        lat_rad, lon_rad, height_m = to_geodetic(place.origin, line)
        p = np.stack([np.rad2deg(lon_rad), np.rad2deg(lat_rad), height_m], axis=1)
    positions = [[round(x, 9), round(y, 9), round(z, 3)] for x, y, z in p.tolist()]
    if np.ptp(line, axis=0).max() == 0.0:
        return {"type": "Point", "coordinates": positions[0]}
    return {"type": "LineString", "coordinates": positions}
