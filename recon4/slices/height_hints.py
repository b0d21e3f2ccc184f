"""Whether heights above sea level meet heights above the ellipsoid."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from recon4.locales.texts import Texts
from recon4.model.tuning import GEOID
from recon4.slices.control_points import ControlPoint
from recon4.slices.tuning import HEIGHT_HINTS


def common_height(up_m: Sequence[float], horizontal_m: Sequence[float], say: Texts) -> str:
    """Whether all measured heights are off by the same, and the points in place horizontally."""
    if not up_m:
        return ""
    usual_m = float(np.median(up_m))
    alike = float(np.abs(np.array(up_m) - usual_m).max()) < HEIGHT_HINTS.nearly_m
    low_m, high_m = GEOID.least_m, GEOID.most_m
    in_place = max(horizontal_m, default=0.0) < HEIGHT_HINTS.nearly_m
    if not (alike and in_place and low_m < abs(usual_m) < high_m):
        return ""
    part = f"{'all' if len(up_m) > 1 else 'one'}-{'high' if usual_m > 0 else 'low'}"
    return say.part("height-hint", part, {"points": len(up_m), "off": abs(usual_m)})


def beside_map(
    points: Sequence[ControlPoint], heights_m: tuple[float, float] | None, say: Texts
) -> str:
    """Whether all points lie as far below or above the map as sea level and ellipsoid are apart."""
    if not points or heights_m is None:
        return ""
    z_m = [point.xyz_m[2] for point in points]
    below_m, above_m = heights_m[0] - max(z_m), min(z_m) - heights_m[1]
    low_m, high_m = GEOID.least_m, GEOID.most_m
    if not low_m < max(below_m, above_m) < high_m:
        return ""
    values = {
        "points": len(points),
        "off": max(below_m, above_m),
        "low": min(z_m),
        "high": max(z_m),
        "map_low": heights_m[0],
        "map_high": heights_m[1],
    }
    return say.part("height-hint", "below" if below_m > 0 else "above", values)
