"""A stable sort of integers by some of their bits."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

_DIGIT = 11


@njit(cache=True, nogil=True, error_model="numpy")
def radix_sort(keys: Any, low_bit: int, high_bit: int, spare: Any) -> Any:
    """Sort by the bits ``low_bit`` to ``high_bit`` (not included), the least digit first.

    Three times as fast as comparing, for some 30 bits.

    Args:
        keys: Not negative, int64 (N,); destroyed.
        low_bit: First bit that counts.
        high_bit: First bit above that does not.
        spare: int64 (N,); destroyed.

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
