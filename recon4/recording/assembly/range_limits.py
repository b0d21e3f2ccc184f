"""Which points of a sensor are used at all, by their range."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.lidars import lidar_model
from recon4.model.rig import Sensor
from recon4.recording.assembly.shots import Shots
from recon4.recording.bags.tuning import CLOUDS
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings


def blind_range_m(sensor: Sensor) -> float:
    """Range below which a sensor measures nothing well [m]."""
    return lidar_model(sensor.model).min_range_m if sensor.kind == "lidar" else 0.0


def drop_invalid(
    shots: Shots, *, settings: IngestSettings, report: ImportReport, blind_m: float = 0.0
) -> Shots:
    """Remove points that are not finite, at the origin, too near or too far; counts them.

    Args:
        shots: Of one sensor.
        settings: Range limits.
        report: Receives the counts.
        blind_m: Range below which the sensor measures nothing well [m].
    """
    with np.errstate(over="ignore", invalid="ignore"):
        square = np.einsum("ni,ni->n", shots.xyz, shots.xyz)
    bad = ~np.isfinite(square) | (square == 0.0)
    near = ~bad & (square < settings.min_range_m**2)
    blind = ~bad & ~near & (square < blind_m**2)
    far = ~bad & (square > settings.max_range_m**2)
    report.count("points_invalid", int(np.count_nonzero(bad)))
    report.count("points_near", int(np.count_nonzero(near)))
    report.count("points_blind", int(np.count_nonzero(blind)))
    report.count("points_far", int(np.count_nonzero(far)))
    if np.count_nonzero(far) > len(shots) // 2 and "points_far" not in report.details:
        _say_extent(shots.xyz[far], settings.max_range_m, report)
    drop = bad | near | blind | far
    return shots.take(~drop) if drop.any() else shots


def _say_extent(xyz: NDArray[np.float32], max_range_m: float, report: ImportReport) -> None:
    """Say once where points are of which most are too far: the unit or the origin may be wrong."""
    found = extent_of(xyz.astype(np.float64))
    report.details["points_far"] = found.text
    report.warn(FindingKind.POINTS_FAR, max_range_m=max_range_m, **found.values)


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
