"""Where the points of a cloud are that are farther away than a LiDAR measures, and why."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import Array
from recon4.recording.tuning_topics import CLOUDS


def extent_text(xyz: Array) -> str:
    """Extent of points, (N, 3) with N > 0, what it looks like, and the remedy."""
    low, high = np.percentile(xyz, CLOUDS.middle, axis=0)
    extent = ", ".join(
        f"{axis} {a:.0f} … {b:.0f}" for axis, a, b in zip("xyz", low, high, strict=True)
    )
    return f"{extent}: {_looks_like(xyz, low, high)}"


def _looks_like(xyz: Array, low: Array, high: Array) -> str:
    middle, size = np.linalg.norm((low + high) / 2.0), float(np.max(high - low))
    usual = float(np.median(np.linalg.norm(xyz, axis=1)))
    if middle > CLOUDS.outside * size:
        return (
            "coordinates of a map or of the earth, not a scan with the sensor at the origin. A "
            "finished map is no recording; give it as a reference"
        )
    if usual > CLOUDS.millimeters_m:
        return (
            f"half of them are farther than {usual:.0f} m. If they are in millimeters, give "
            "ingest.points_unit_m=0.001; a map whose origin is no sensor is no recording"
        )
    return (
        f"half of them are farther than {usual:.0f} m. If the sensor measures that far, give a "
        "larger ingest.max_range_m"
    )
