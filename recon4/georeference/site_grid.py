"""The grid of a site: coordinates that control points alone define."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.errors import GeoreferenceError
from recon4.geometry.se3 import Array
from recon4.georeference.tuning_control import SITE_GRIDS
from recon4.locales.coded import CodedText
from recon4.model.site_control import SITE_GRID

_WKT = (
    'LOCAL_CS["site grid of the control points",LOCAL_DATUM["site",0],'
    'UNIT["metre",1],AXIS["Easting",EAST],AXIS["Northing",NORTH]]'
)


@dataclass(frozen=True, slots=True)
class SiteGrid:
    """Transforms points of the map to the grid of a site: a shift, no scale and no turn."""

    origin_m: tuple[float, float, float]
    """Easting, northing, height of the map's origin [m]."""

    @property
    def crs(self) -> str:
        """Its name, in place of a code."""
        return SITE_GRID

    @property
    def wkt(self) -> str:
        """As WKT 1, as LAS 1.4 requires: an engineering system without a place on earth."""
        return _WKT

    @property
    def operation(self) -> str:
        """How the map gets there."""
        return "adjusted to control points"

    @property
    def accuracy_m(self) -> float:
        """Stated accuracy of the transformation [m]: unknown."""
        return float("nan")

    def to_crs(self, p_map: Array) -> Array:
        """Easting, northing, height of points of the map [m], (N, 3) -> (N, 3)."""
        return np.asarray(p_map, dtype=np.float64) + np.array(self.origin_m)

    def to_map(self, p_crs: Array) -> Array:
        """The inverse of `to_crs` [m], (N, 3) -> (N, 3)."""
        return np.asarray(p_crs, dtype=np.float64) - np.array(self.origin_m)

    @staticmethod
    def around(xyz_m: Sequence[tuple[float, float, float]] | Array) -> SiteGrid:
        """The grid with an origin near surveyed points, which keeps numbers in the map small.

        Small coordinates keep their origin: map and site are then the same.

        Args:
            xyz_m: Easting, northing, height [m], (N, 3).

        Raises:
            GeoreferenceError: If one is not a number.
        """
        p = np.asarray(xyz_m, dtype=np.float64).reshape(-1, 3)
        if not np.isfinite(p).all():
            raise GeoreferenceError(CodedText("control-not-finite"))
        middle = p.mean(axis=0)
        near = np.abs(p).max(axis=0) < SITE_GRIDS.small_m
        step = SITE_GRIDS.step_m
        x, y, z = np.where(near, 0.0, np.round(middle / step) * step).tolist()
        return SiteGrid((x, y, z))
