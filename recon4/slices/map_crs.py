"""Transformation between the map frame and its coordinate reference system."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.errors import GeoreferenceError, StoreError
from recon4.export.points import ToCrs
from recon4.geometry.se3 import Array
from recon4.georeference.crs_file import read_crs
from recon4.georeference.geojson_crs import geojson_crs
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.slices.tuning import MAP_FRAMES


@dataclass(frozen=True, slots=True, eq=False)
class MapFrame:
    """Coordinate frame of a project's map, and its CRS if there is one."""

    crs: str
    """Code as ``EPSG:32633``; empty = the map is local."""
    wkt: str
    to_crs: ToCrs | None

    @property
    def text(self) -> str:
        """Caption for sheets and files: frame, axes, unit, CRS coordinates of the origin."""
        if self.to_crs is None:
            return "map frame (local), x y z, z up, meters"
        east, north, up = self.to_crs(np.zeros((1, 3)))[0].tolist()
        place = f"origin at E {east:.3f} N {north:.3f} H {up:.3f} in {self.crs}"
        return f"map frame ({place}), x y z, z up, meters"

    @property
    def written_text(self) -> str:
        """What the coordinates of a file are that was put into the CRS, if there is one."""
        if self.to_crs is None:
            return self.text
        return f"easting, northing, height in {self.crs}, meters"

    @property
    def geojson_crs(self) -> dict[str, object]:
        """The member ``crs`` of a GeoJSON file of points that were put into the CRS."""
        return geojson_crs(self.crs, self.wkt)

    def from_crs(self, p_crs: Array) -> Array:
        """Points of the CRS in the map [m], (N, 3): Newton steps on `to_crs`, to 1 µm.

        Raises:
            GeoreferenceError: If the map is local, or the points are not near it.
        """
        if self.to_crs is None:
            raise GeoreferenceError(CodedText("map-local"))
        J, origin = jacobian(self.to_crs, np.zeros(3))
        back = np.asarray(np.linalg.inv(J), dtype=np.float64)
        p_map: Array = (p_crs - origin) @ back.T
        if len(p_map) and not np.abs(p_map).max() < 1e6:
            raise GeoreferenceError(CodedText("map-crs-far", crs=self.crs))
        for _ in range(MAP_FRAMES.rounds):
            off: Array = (p_crs - self.to_crs(p_map)) @ back.T
            p_map = p_map + off
            if not len(off) or np.abs(off).max() < 1e-6:
                break
        return p_map


LOCAL = MapFrame("", "", None)
"""Of a map that is not georeferenced."""


def jacobian(to_crs: ToCrs, p_map: Array) -> tuple[Array, Array]:
    """Derivative of the CRS coordinates by the map coordinates at a point.

    Returns:
        Derivative (3, 3), columns are the map's axes; and the point in the CRS (3,).
    """
    steps = np.concatenate([np.eye(3), -np.eye(3)]) * MAP_FRAMES.step_m
    around = to_crs(np.concatenate([p_map + steps, p_map[None]]))
    J: Array = ((around[:3] - around[3:6]) / (2.0 * MAP_FRAMES.step_m)).T
    return J, around[6]


def frame_of(artifacts: dict[str, Path], crs: str = "") -> MapFrame:
    """The frame of a project's map; local if the map is not georeferenced.

    Args:
        artifacts: Stage -> folder of its artifact.
        crs: Code of another CRS; empty = that of the map.

    Raises:
        GeoreferenceError: If another CRS is requested and the map is not georeferenced.
        StoreError: If there is no map.
    """
    if "map" not in artifacts:
        raise StoreError(CodedText("map-missing"))
    level = artifacts.get("level")
    if level is not None and (level / "georeference.json").exists():
        place = read_crs(level, crs)
        if place is not None:
            return MapFrame(place.crs, place.wkt, place.to_crs)
    if crs:
        raise GeoreferenceError(CodedText("map-crs-unknown-place", crs=crs))
    own = TileSet.open(artifacts["map"]).crs
    if own is not None:
        shift = np.array(own.origin_m)
        return MapFrame("its CRS", own.wkt, lambda p: np.asarray(p, dtype=np.float64) + shift)
    return LOCAL
