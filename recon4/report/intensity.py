"""How intensity depends on beam, range and incidence, before and after (V Fig. 2.13)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.report.tuning import INTENSITY_CHARTS

_NAMES = (
    ("channel", "beam (all sensors)"),
    ("range", "range [m]"),
    ("incidence", "incidence [deg]"),
)
_CLASSES = {"range": "range_m", "incidence": "incidence_deg"}


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """Intensity in classes of one quantity, before and after."""

    x: Array
    """Centers of the classes with points, (N,)."""
    raw: Array
    """(N,)."""
    normalized: Array
    """(N,)."""
    spread_raw: float
    """Standard deviation of the classes' values, weighted by points."""
    spread_normalized: float
    """The same after normalization: the smaller, the flatter the curve."""


@dataclass(frozen=True, slots=True, eq=False)
class Dependency:
    """Mean intensity in classes of one quantity."""

    name: str
    label: str
    """Name of the axis with its unit."""
    mean: Curve
    """Mean intensity."""
    same: Curve | None
    """Intensity over that of the same surface; None = not known."""


def dependencies(diagnostics: Mapping[str, NDArray[np.floating]]) -> tuple[Dependency, ...]:
    """Curves from ``diagnostics.npz`` of the stage ``intensity``, those that have points."""
    curves = [_dependency(diagnostics, name, label) for name, label in _NAMES]
    return tuple(curve for curve in curves if curve is not None)


def _dependency(
    diagnostics: Mapping[str, NDArray[np.floating]], name: str, label: str
) -> Dependency | None:
    count, before, after = (diagnostics.get(f"{name}_{k}") for k in ("count", "before", "after"))
    if count is None or before is None or after is None:
        return None
    classes = diagnostics.get(_CLASSES.get(name, ""), np.arange(len(count)))
    mean = _curve(classes, count, before[0], normalized=after[0])
    if mean is None:
        return None
    same, seen = diagnostics.get(f"{name}_same"), diagnostics.get(f"{name}_same_count")
    compared = (
        None if same is None or seen is None else _curve(classes, seen, same[0], normalized=same[1])
    )
    return Dependency(name, label, mean, compared)


def _curve(
    classes: NDArray[np.generic],
    count: NDArray[np.floating],
    raw: NDArray[np.floating],
    *,
    normalized: NDArray[np.floating],
) -> Curve | None:
    used = (count >= INTENSITY_CHARTS.min_points) & np.isfinite(raw) & np.isfinite(normalized)
    if not used.any():
        return None
    raw, normalized, weight = raw[used], normalized[used], count[used]
    return Curve(
        x=classes[used].astype(np.float64),
        raw=raw.astype(np.float64),
        normalized=normalized.astype(np.float64),
        spread_raw=_spread(raw, weight),
        spread_normalized=_spread(normalized, weight),
    )


def _spread(mean: NDArray[np.floating], count: NDArray[np.floating]) -> float:
    middle = np.average(mean, weights=count)
    return float(np.sqrt(np.average((mean - middle) ** 2, weights=count)))
