"""Kernels of intensity normalization."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def bin_of(
    incidence_rad: float,
    range_m: float,
    incidence_bin_rad: float,
    range_bin_m: float,
    shape: tuple[int, ...],
) -> tuple[int, int]:
    """Bin of incidence (last: no normal) and of range (last: all farther points)."""
    if np.isnan(incidence_rad):
        i = shape[1] - 1
    else:
        i = min(int(incidence_rad / incidence_bin_rad), shape[1] - 2)
    return i, min(int(range_m / range_bin_m), shape[2] - 1)


@njit(cache=True, nogil=True, error_model="numpy")
def accumulate(
    intensity: NDArray[np.uint16],
    channel: NDArray[np.int64],
    incidence_rad: NDArray[np.float32],
    range_m: NDArray[np.float32],
    incidence_bin_rad: float,
    range_bin_m: float,
    sums: NDArray[np.float64],
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
    intensity: NDArray[np.uint16],
    sensor: NDArray[np.uint8],
    ring: NDArray[np.uint8],
    incidence_rad: NDArray[np.float32],
    range_m: NDArray[np.float32],
    incidence_bin_rad: float,
    range_bin_m: float,
    gain: NDArray[np.float32],
    offset: NDArray[np.float32],
    upper: float,
    out: NDArray[np.float32],
) -> None:
    """Normalize intensities: ``gain * x + offset`` of each point's bin, clamped to 0..upper.

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
        upper: Largest normalized intensity.
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


@njit(cache=True, nogil=True, error_model="numpy")
def bins_of(
    channel: NDArray[np.int64],
    incidence_rad: NDArray[np.float32],
    range_m: NDArray[np.float32],
    incidence_bin_rad: float,
    range_bin_m: float,
    shape: tuple[int, ...],
    out: NDArray[np.int32],
) -> None:
    """Channel, bin of incidence and bin of range of each point, ``out (N, 3)``.

    ``shape`` has the numbers of channels, bins of incidence and bins of range.
    """
    for n in range(len(channel)):
        i, r = bin_of(incidence_rad[n], range_m[n], incidence_bin_rad, range_bin_m, shape)
        out[n, 0], out[n, 1], out[n, 2] = channel[n], i, r


@njit(cache=True, nogil=True, error_model="numpy")
def surface_equations(
    starts: NDArray[np.int64],
    parameters: NDArray[np.int32],
    intensity: NDArray[np.float32],
    theta: NDArray[np.float64],
    H: NDArray[np.float64],
    g: NDArray[np.float64],
) -> None:
    """Newton's equations of a log-linear model with an unknown brightness for each cell.

    The expected intensity of point n in cell c is ``b_c exp(theta_i + theta_j + theta_k)``. For
    given theta the most likely ``b_c`` is the sum of intensities over the sum of the exponentials.
    It is substituted, so that the equations contain theta only, for any number of cells.

    Args:
        starts: First point of each cell and the number of points, (C + 1,).
        parameters: Rows i, j, k of theta of each point, sorted by cell, (N, 3).
        intensity: float32 (N,).
        theta: (P,).
        H: Receives the negative second derivatives, (P, P).
        g: Receives the first derivatives, (P,).
    """
    factor = np.exp(theta)
    sums = np.zeros(len(theta))
    touched = np.empty(len(theta), np.int64)
    for c in range(len(starts) - 1):
        seen, expected = 0.0, 0.0
        for n in range(starts[c], starts[c + 1]):
            i, j, k = parameters[n]
            seen += intensity[n]
            expected += factor[i] * factor[j] * factor[k]
        if seen <= 0.0:
            continue
        brightness, used = seen / expected, 0
        for n in range(starts[c], starts[c + 1]):
            i, j, k = parameters[n]
            m = brightness * factor[i] * factor[j] * factor[k]
            for a in (i, j, k):
                g[a] += intensity[n] - m
                if sums[a] == 0.0:
                    touched[used] = a
                    used += 1
                sums[a] += m
                for b in (i, j, k):
                    H[a, b] += m
        for a in touched[:used]:
            ratio = sums[a] / seen
            for b in touched[:used]:
                H[a, b] -= ratio * sums[b]
        for a in touched[:used]:
            sums[a] = 0.0
