"""Which of several places along a weak direction the points show.

Surfaces that face a weak direction often lie a few centimeters behind each other: the door in the
end of a corridor, set back from its wall, or the reveals of doors. Each of them draws the points to
itself, from half the distance between them. A prediction by scans is wrong by more than that now
and then, and the nearest place may be the one where few points lie on anything.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from recon4.geometry.se3 import Array
from recon4.registration.tuning import PLANES
from recon4.registration.tuning_matching import FRAME_FIT, POINT_MAP, WEAK_PLACES

Distances = Callable[[float], Array]
"""Distance of each point from its plane with the body shifted by a distance [m], (N,); NaN = no
plane there."""


def better_place_m(distances: Distances, *, shifted_m: float) -> float:
    """Shift along a weak direction to where clearly more of the points lie on planes [m].

    The cost of a shift is that of the points, with the Cauchy kernel of the planes, and that of the
    prediction::

        c(s) = scale k² / (2 σ²) Σ log(1 + (r(s) / k)²) + (s + s₀)² / (2 σ_e²)

    A point without a plane counts as one at the gate. The least of it is the place if the minimum
    that is reached downhill from no shift costs more by `WEAK_PLACES.clear`.

    Args:
        distances: Of the points, by a shift.
        shifted_m: Distance of the body from the predicted place already [m], s₀.

    Returns:
        0.0 if the place is that of the next minimum.
    """
    reach, step_m = WEAK_PLACES.steps, WEAK_PLACES.step_m
    shifts_m = step_m * np.arange(-reach, reach + 1)
    cost = np.array([_cost(distances(float(shift_m))) for shift_m in shifts_m])
    cost += 0.5 * ((shifts_m + shifted_m) / FRAME_FIT.expected_sd[1]) ** 2
    best = int(cost.argmin())
    if cost[best] > cost[_downhill(cost, reach)] - WEAK_PLACES.clear:
        return 0.0
    return float(shifts_m[best])


def _cost(distance_m: Array) -> float:
    """Half the sum of what the points cost, (N,) [m]; NaN = no plane."""
    far = np.where(np.isnan(distance_m), POINT_MAP.gate_m, distance_m) / PLANES.kernel_m
    weight = 0.5 * POINT_MAP.scale * (PLANES.kernel_m / PLANES.point_sd_m) ** 2
    return weight * float(np.log1p(far**2).sum())


def _downhill(cost: Array, row: int) -> int:
    """Row of the minimum that is reached from a row."""
    while True:
        near = slice(max(row - 1, 0), row + 2)
        lowest = near.start + int(cost[near].argmin())
        if cost[lowest] >= cost[row]:
            return row
        row = lowest
