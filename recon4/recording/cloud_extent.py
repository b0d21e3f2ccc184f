"""Where the points of a cloud are that are farther away than a LiDAR measures, and why."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.finding import Value
from recon4.recording.tuning_topics import CLOUDS


@dataclass(frozen=True, slots=True, eq=False)
class CloudExtent:
    """Where most points of a cloud are."""

    low_m: Array
    """Lower ends of x, y and z [m], (3,)."""
    high_m: Array
    """Upper ends [m], (3,)."""
    usual_m: float
    """Median distance to the origin [m]."""
    looks: str
    """What it looks like: coordinates of a ``map``, another ``unit``, or a large ``range``."""

    @property
    def text(self) -> CodedText:
        """In words, with the remedy."""
        return CodedText(f"extent-{self.looks}", axes=self._axes, usual_m=self.usual_m)

    @property
    def values(self) -> dict[str, Value]:
        """As values of a finding."""
        return {"extent": self._axes, "usual_m": self.usual_m, self.looks: True}

    @property
    def _axes(self) -> str:
        ends = zip("xyz", self.low_m, self.high_m, strict=True)
        return ", ".join(f"{axis} {low:.0f} … {high:.0f}" for axis, low, high in ends)


def extent_of(xyz: Array) -> CloudExtent:
    """Extent of points, (N, 3) with N > 0."""
    low, high = np.percentile(xyz, CLOUDS.middle, axis=0)
    usual_m = float(np.median(np.linalg.norm(xyz, axis=1)))
    return CloudExtent(low, high, usual_m, _looks(low, high, usual_m))


def _looks(low: Array, high: Array, usual_m: float) -> str:
    middle, size = np.linalg.norm((low + high) / 2.0), float(np.max(high - low))
    if middle > CLOUDS.outside * size:
        return "map"
    return "unit" if usual_m > CLOUDS.millimeters_m else "range"
