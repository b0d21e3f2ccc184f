"""Kernels that take multiframes apart into bytes that compress well, and put them together."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

NUMBERS = len(("x", "y", "z", "dt_ns", "intensity"))
"""Numbers of a point that are packed, in this order."""
BEAMS = np.iinfo(np.uint8).max + 1
"""As many as a ring can name."""


@njit(cache=True, nogil=True, error_model="numpy")
def differences(
    beam: tuple[NDArray[np.uint8], NDArray[np.uint8]],
    xyz: NDArray[np.float32],
    per_meter: float,
    dt_ns: NDArray[np.int32],
    intensity: NDArray[np.uint16],
    last: NDArray[np.int32],
    out: NDArray[np.uint8],
) -> None:
    """Differences of each point to the one before it on the same beam, byte by byte.

    The sign becomes the lowest bit, so that the upper bytes of small differences are zero. A
    difference that needs more than 32 bits wraps; `points_of` wraps it back.

    Args:
        beam: Sensor and ring of each point, two arrays uint8 (N,).
        xyz: Coordinates [m], float32 (N, 3).
        per_meter: Steps in a meter to which they are rounded.
        dt_ns: int32 (N,).
        intensity: uint16 (N,).
        last: Zeros; the newest numbers of each beam, int32 (S * BEAMS, NUMBERS).
        out: Receives the bytes, the lowest of all points first, uint8 (NUMBERS, 4, N).
    """
    for n in range(len(xyz)):
        row = np.int64(beam[0][n]) * BEAMS + beam[1][n]
        for k in range(NUMBERS):
            if k < 3:
                value = np.int32(np.rint(xyz[n, k] * per_meter))
            elif k == 3:
                value = np.int32(dt_ns[n])
            else:
                value = np.int32(intensity[n])
            step = np.int32((np.int64(value) - last[row, k]) & 0xFFFFFFFF)
            last[row, k] = value
            bits = np.uint32((step << 1) ^ (step >> 31))
            for byte in range(4):
                out[k, byte, n] = (bits >> (8 * byte)) & 0xFF


@njit(cache=True, nogil=True, error_model="numpy")
def points_of(
    beam: tuple[NDArray[np.uint8], NDArray[np.uint8]],
    packed: NDArray[np.uint8],
    step_m: float,
    last: NDArray[np.int32],
    xyz: NDArray[np.float32],
    dt_ns: NDArray[np.int32],
    intensity: NDArray[np.uint16],
) -> None:
    """The points of `differences`.

    Args:
        beam: Sensor and ring of each point, two arrays uint8 (N,).
        packed: The bytes, uint8 (NUMBERS, 4, N).
        step_m: Step of the coordinates [m].
        last: Zeros; the newest numbers of each beam, int32 (S * BEAMS, NUMBERS).
        xyz: Receives the coordinates [m], float32 (N, 3).
        dt_ns: Receives the times, int32 (N,).
        intensity: Receives the intensities, uint16 (N,).
    """
    for n in range(len(xyz)):
        row = np.int64(beam[0][n]) * BEAMS + beam[1][n]
        for k in range(NUMBERS):
            bits = np.int64(0)
            for byte in range(4):
                bits |= np.int64(packed[k, byte, n]) << (8 * byte)
            step = (bits >> 1) ^ -(bits & 1)
            value = np.int32((last[row, k] + step) & 0xFFFFFFFF)
            last[row, k] = value
            if k < 3:
                xyz[n, k] = value * step_m
            elif k == 3:
                dt_ns[n] = value
            else:
                intensity[n] = value & 0xFFFF
