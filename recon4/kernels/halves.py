"""Kernel that rounds float32 to float16."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def round_to_half(
    values: NDArray[np.float32], bits: NDArray[np.uint32], out: NDArray[np.uint16]
) -> None:
    """Round to the nearest float16, ties to even, as numpy does.

    Numpy reports every underflow to the processor, which takes ten times as long for numbers near
    zero: most components of normals and offsets.

    Args:
        values: (N,).
        bits: The same memory as unsigned integers, (N,).
        out: Receives the bits of the halves, (N,).
    """
    for n in range(len(values)):
        size: Any = np.int64(bits[n] & 0x7FFFFFFF)
        if size >= 0x47800000:
            half: Any = np.int64(0x7E00 if size > 0x7F800000 else 0x7C00)
        elif size < 0x38800000:
            half = np.int64(np.rint(abs(np.float64(values[n])) * 16777216.0))
        else:
            half = (size - 0x38000000 + 0xFFF + ((size >> 13) & 1)) >> 13
        out[n] = half | (np.int64(bits[n]) >> 16 & 0x8000)
