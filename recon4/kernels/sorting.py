"""Kernel of a stable radix sort of integers by some of their bits."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

_DIGIT = 14


@njit(cache=True, nogil=True, error_model="numpy")
def radix_sort(
    keys: NDArray[np.int64], low_bit: int, high_bit: int, spare: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Sort by the bits ``low_bit`` to ``high_bit`` (not included), the least digit first.

    Three times as fast as a comparison sort, for some 30 bits.

    Args:
        keys: Not negative, int64 (N,); overwritten.
        low_bit: First bit of the sort key.
        high_bit: First bit above the sort key.
        spare: Scratch, int64 (N,); overwritten.

    Returns:
        The sorted keys: one of the two arrays.
    """
    for shift in range(low_bit, high_bit, _DIGIT):
        digits = np.int64((1 << min(_DIGIT, high_bit - shift)) - 1)
        ends = np.zeros(digits + 2, np.int64)
        for n in range(len(keys)):
            ends[((keys[n] >> shift) & digits) + 1] += 1
        for d in range(digits + 1):
            ends[d + 1] += ends[d]
        for n in range(len(keys)):
            d = (keys[n] >> shift) & digits
            spare[ends[d]] = keys[n]
            ends[d] += 1
        keys, spare = spare, keys
    return keys
