"""Hot loops of intensity normalization."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit


@njit(cache=True, nogil=True, error_model="numpy")
def bin_of(
    incidence_rad: float, range_m: float, incidence_bin_rad: float, range_bin_m: float, shape: Any
) -> tuple[int, int]:
    """Bin of incidence (the last one: no normal) and of range (the last one: and farther)."""
    if np.isnan(incidence_rad):
        i = shape[1] - 1
    else:
        i = min(np.int64(incidence_rad / incidence_bin_rad), shape[1] - 2)
    return i, min(np.int64(range_m / range_bin_m), shape[2] - 1)


@njit(cache=True, nogil=True, error_model="numpy")
def accumulate(
    intensity: Any,
    channel: Any,
    incidence_rad: Any,
    range_m: Any,
    incidence_bin_rad: float,
    range_bin_m: float,
    sums: Any,
) -> None:
    """Add count, sum and sum of squares of the points to ``sums (C, I, R, 3)``."""
    for n in range(len(intensity)):
        i, r = bin_of(incidence_rad[n], range_m[n], incidence_bin_rad, range_bin_m, sums.shape)
        x = np.float64(intensity[n])
        cell = sums[channel[n], i, r]
        cell[0] += 1.0
        cell[1] += x
        cell[2] += x * x


@njit(cache=True, nogil=True, error_model="numpy")
def apply_table(
    intensity: Any,
    sensor: Any,
    ring: Any,
    incidence_rad: Any,
    range_m: Any,
    incidence_bin_rad: float,
    range_bin_m: float,
    gain: Any,
    offset: Any,
    upper: float,
    out: Any,
) -> None:
    """``gain * x + offset`` of each point's bin, clamped to 0..upper.

    Args:
        intensity: uint16 (N,).
        sensor: uint8 (N,).
        ring: uint8 (N,).
        incidence_rad: float32 (N,), NaN without a normal.
        range_m: float32 (N,).
        incidence_bin_rad: Width of a bin [rad].
        range_bin_m: Width of a bin [m].
        gain: float32 (S, B, I, R).
        offset: float32 (S, B, I, R).
        upper: Largest result.
        out: Receives the results, float32 (N,); a channel without a table keeps its values.
    """
    for n in range(len(intensity)):
        x = np.float32(intensity[n])
        s, b = sensor[n], ring[n]
        if s < gain.shape[0] and b < gain.shape[1]:
            i, r = bin_of(
                incidence_rad[n], range_m[n], incidence_bin_rad, range_bin_m, gain.shape[1:]
            )
            x = gain[s, b, i, r] * x + offset[s, b, i, r]
        out[n] = min(max(x, np.float32(0.0)), np.float32(upper))
