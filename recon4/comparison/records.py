"""Records of a comparison of two maps."""

from __future__ import annotations

from dataclasses import dataclass, fields
from enum import IntEnum
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from recon4.comparison.tuning import M3C2
from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText


class CoreState(IntEnum):
    """What is known of a core point; every core point has one."""

    BELOW_LOD = 0
    """It has a distance, which may be noise."""
    SIGNIFICANT = 1
    """Its distance is beyond the level of detection."""
    WITHOUT_PARTNER = 2
    """The other map has no surface in its cylinder: removed, new, moved farther, or not seen."""
    WITHOUT_NORMAL = 3
    """Too few neighbors, or neighbors on a line: no direction to measure in."""
    SPARSE = 4
    """Too few points of its own map in its cylinder to state a level of detection."""


@dataclass(frozen=True, slots=True, kw_only=True)
class M3C2Scales:
    """Sizes of a comparison."""

    core_spacing_m: float = 0.1
    """Distance of core points [m]."""
    normal_m: float = 0.3
    """Diameter of the neighborhood of a normal, ``D`` [m]."""
    cylinder_m: float = 0.15
    """Diameter of a cylinder, ``d`` [m]."""
    depth_m: float = 0.5
    """Half the length of a cylinder: larger distances have no partner [m]."""
    layer_m: float = 0.1
    """Half the thickness of what counts as one surface [m]; ``depth_m``: all of the cylinder, as
    in the paper."""

    @staticmethod
    def of_maps(voxels_m: tuple[float, float], *, core_spacing_m: float) -> M3C2Scales:
        """The usual ones, or larger ones for maps whose points are far apart.

        Args:
            voxels_m: Voxels of the two maps [m]; 0 = all points were kept.
            core_spacing_m: Distance of core points [m].
        """
        apart, usual = max(voxels_m), M3C2Scales()
        return M3C2Scales(
            core_spacing_m=core_spacing_m,
            normal_m=max(usual.normal_m, M3C2.normal_voxels * apart),
            cylinder_m=max(usual.cylinder_m, M3C2.cylinder_voxels * apart),
            depth_m=max(usual.depth_m, M3C2.normal_voxels * apart),
            layer_m=max(usual.layer_m, M3C2.layer_voxels * apart),
        )

    def check(self) -> M3C2Scales:
        """Itself.

        Raises:
            ConfigError: If a size is out of range.
        """
        least, most = M3C2.spacing_m
        if not least <= self.core_spacing_m <= most:
            raise ConfigError(
                CodedText(
                    "compare-spacing", least=least, most=most, core_spacing_m=self.core_spacing_m
                )
            )
        for field in fields(self)[1:]:
            value = getattr(self, field.name)
            if not 0.0 < value <= M3C2.longest_m:
                raise ConfigError(
                    CodedText(
                        "compare-length",
                        field=field.name,
                        longest_m=M3C2.longest_m,
                        value=str(value),
                    )
                )
        return self


@dataclass(frozen=True, slots=True, eq=False)
class CoreDifferences:
    """Differences at the core points of a tile."""

    p_map: Array
    """Core points in the first map [m], (N, 3)."""
    normal: NDArray[np.float32]
    """Unit normals towards the sensor, zeros = none, (N, 3)."""
    distance_m: NDArray[np.float32]
    """From the first map to the second along the normal [m], (N,); NaN = none. Positive: the
    second lies in front, on the side from which the surface was seen."""
    lod_m: NDArray[np.float32]
    """Level of detection at 95 % [m], (N,); NaN without a distance."""
    points: NDArray[np.int32]
    """Points of the first and of the second map that the distance is computed from, (N, 2)."""
    state: NDArray[np.uint8]
    """`CoreState`, (N,)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DifferenceCounts:
    """How many core points there are of each state."""

    core_points: int = 0
    """All of them: the sum of the others."""
    significant: int = 0
    below_lod: int = 0
    without_partner: int = 0
    without_normal: int = 0
    sparse: int = 0

    @property
    def compared(self) -> int:
        """Those with a distance."""
        return self.significant + self.below_lod


@dataclass(frozen=True, slots=True, kw_only=True)
class DistanceFigures:
    """Of all core points with a distance."""

    mean_m: float
    sd_m: float
    """Standard deviation about the mean."""
    p50_m: float
    """Median of the absolute distances."""
    p95_m: float
    """Of the absolute distances."""
    largest_m: float
    """Largest absolute distance."""
    lod_p50_m: float
    """Median of the levels of detection."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparedMap:
    """One of the two maps."""

    name: str
    """Of its project."""
    key: str
    """Of the artifact of the map."""
    points: int
    registration: Literal["stated", "usual"]
    """Whether the map states the standard deviations of its positions; else the usual one of a
    good map was used."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapDifferences:
    """The result of a comparison without its points."""

    first: ComparedMap
    second: ComparedMap
    relation: str
    """Why the two have a common frame, in words."""
    T_a_b: list[list[float]]
    """Maps points of the second map into the first, 4 x 4, row by row."""
    scales: M3C2Scales
    counts: DifferenceCounts
    distances: DistanceFigures | None
    """None = no core point has a distance."""


class DifferenceTally:
    """Counts and sums of differences, without keeping them."""

    def __init__(self) -> None:
        self._states = np.zeros(len(CoreState), np.int64)
        self._sum = self._squares = self._largest = 0.0
        classes = round(M3C2.longest_m / M3C2.step_m) + 2
        self._distances, self._lods = np.zeros(classes, np.int64), np.zeros(classes, np.int64)

    def add(self, found: CoreDifferences) -> None:
        """Add the core points of a tile."""
        self._states += np.bincount(found.state, minlength=len(self._states))
        known = found.state <= CoreState.SIGNIFICANT
        d = found.distance_m[known].astype(np.float64)
        self._sum += float(d.sum())
        self._squares += float((d**2).sum())
        self._largest = max(self._largest, float(np.abs(d).max(initial=0.0)))
        self._distances += _classes(np.abs(d), len(self._distances))
        self._lods += _classes(found.lod_m[known].astype(np.float64), len(self._lods))

    def counts(self) -> DifferenceCounts:
        """How many core points there are."""
        of = {state: int(self._states[state]) for state in CoreState}
        return DifferenceCounts(
            core_points=sum(of.values()),
            significant=of[CoreState.SIGNIFICANT],
            below_lod=of[CoreState.BELOW_LOD],
            without_partner=of[CoreState.WITHOUT_PARTNER],
            without_normal=of[CoreState.WITHOUT_NORMAL],
            sparse=of[CoreState.SPARSE],
        )

    def figures(self) -> DistanceFigures | None:
        """Figures of the distances; None = there are none."""
        n = self.counts().compared
        if not n:
            return None
        mean = self._sum / n
        return DistanceFigures(
            mean_m=mean,
            sd_m=float(np.sqrt(max(0.0, self._squares / n - mean**2))),
            p50_m=min(_percentile(self._distances, 0.5), self._largest),
            p95_m=min(_percentile(self._distances, 0.95), self._largest),
            largest_m=self._largest,
            lod_p50_m=_percentile(self._lods, 0.5),
        )


def _classes(values: Array, count: int) -> NDArray[np.int64]:
    at = np.minimum(values / M3C2.step_m, count - 1).astype(np.int64)
    return np.bincount(at, minlength=count)


def _percentile(histogram: NDArray[np.int64], part: float) -> float:
    """Middle of the class below which a part of the values lies [m]."""
    row = int(np.searchsorted(np.cumsum(histogram), part * histogram.sum()))
    return (row + 0.5) * M3C2.step_m
