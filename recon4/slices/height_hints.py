"""Whether heights above sea level meet heights above the ellipsoid."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from recon4.model.tuning import GEOID
from recon4.slices.control_points import ControlPoint
from recon4.slices.tuning import HEIGHT_HINTS

_TWO_HEIGHTS = (
    "This is as with a geoid: either the map or the survey has heights above sea level "
    "(orthometric), and the other above the ellipsoid."
)


def common_height(up_m: Sequence[float], horizontal_m: Sequence[float]) -> str:
    """Whether all measured heights are off by the same, and the points in place horizontally."""
    if not up_m:
        return ""
    usual_m = float(np.median(up_m))
    alike = float(np.abs(np.array(up_m) - usual_m).max()) < HEIGHT_HINTS.nearly_m
    low_m, high_m = GEOID.least_m, GEOID.most_m
    in_place = max(horizontal_m, default=0.0) < HEIGHT_HINTS.nearly_m
    if not (alike and in_place and low_m < abs(usual_m) < high_m):
        return ""
    points = f"All {len(up_m)} points are" if len(up_m) > 1 else "The point is"
    return (
        f"{points} {abs(usual_m):.2f} m too {'high' if usual_m > 0 else 'low'} in the map, and "
        f"horizontally in place. {_TWO_HEIGHTS}"
    )


def beside_map(points: Sequence[ControlPoint], heights_m: tuple[float, float] | None) -> str:
    """Whether all points lie as far below or above the map as sea level and ellipsoid are apart."""
    if not points or heights_m is None:
        return ""
    z_m = [point.xyz_m[2] for point in points]
    below_m, above_m = heights_m[0] - max(z_m), min(z_m) - heights_m[1]
    low_m, high_m = GEOID.least_m, GEOID.most_m
    if not low_m < max(below_m, above_m) < high_m:
        return ""
    return (
        f"All {len(points)} points of the survey are {'below' if below_m > 0 else 'above'} the map "
        f"by {max(below_m, above_m):.0f} m and more: their heights are {min(z_m):.1f} to "
        f"{max(z_m):.1f} m, the map's {heights_m[0]:.1f} to {heights_m[1]:.1f} m. {_TWO_HEIGHTS}"
    )
