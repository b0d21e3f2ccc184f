"""How intensity depends on beam, range and incidence, before and after (V Fig. 2.13)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array

_MIN_POINTS = 100
_NAMES = (
    ("channel", "beam (all sensors)"),
    ("range", "range [m]"),
    ("incidence", "incidence [deg]"),
)
_CLASSES = {"range": "range_m", "incidence": "incidence_deg"}


@dataclass(frozen=True, slots=True, eq=False)
class Dependency:
    """Mean intensity in classes of one quantity."""

    name: str
    label: str
    """Name of the axis with its unit."""
    x: Array
    """The classes that hold points, (N,)."""
    raw: Array
    """Mean raw intensity, (N,)."""
    normalized: Array
    """Mean normalized intensity, (N,)."""
    spread_raw: float
    """Standard deviation of the classes' means, weighted by points."""
    spread_normalized: float
    """The same after normalization: the smaller, the flatter the curve."""


def dependencies(diagnostics: Mapping[str, NDArray[np.floating]]) -> tuple[Dependency, ...]:
    """Curves from ``diagnostics.npz`` of the stage ``intensity``, those that have points."""
    curves = [_curve(diagnostics, name, label) for name, label in _NAMES]
    return tuple(curve for curve in curves if curve is not None)


def _curve(
    diagnostics: Mapping[str, NDArray[np.floating]], name: str, label: str
) -> Dependency | None:
    columns = [diagnostics.get(f"{name}_{part}") for part in ("count", "before", "after")]
    count, before, after = columns
    if count is None or before is None or after is None:
        return None
    used = (count >= _MIN_POINTS) & np.isfinite(before[0]) & np.isfinite(after[0])
    if not used.any():
        return None
    classes = diagnostics.get(_CLASSES.get(name, ""), np.arange(len(count)))
    raw, normalized, weight = before[0][used], after[0][used], count[used]
    return Dependency(
        name=name,
        label=label,
        x=classes[used].astype(np.float64),
        raw=raw.astype(np.float64),
        normalized=normalized.astype(np.float64),
        spread_raw=_spread(raw, weight),
        spread_normalized=_spread(normalized, weight),
    )


def _spread(mean: NDArray[np.floating], count: NDArray[np.floating]) -> float:
    middle = np.average(mean, weights=count)
    return float(np.sqrt(np.average((mean - middle) ** 2, weights=count)))
