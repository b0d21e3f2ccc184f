"""Kernel for the checksums of Hesai's packets."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def crc32_of_rows(rows: NDArray[np.uint8], table: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """CRC-32 of each row, highest bit first, (N,).

    Args:
        rows: Bytes, (N, K).
        table: What each byte changes, (256,).
    """
    out = np.empty(len(rows), np.uint32)
    for row in range(len(rows)):
        total = np.uint32(0xFFFFFFFF)
        for k in range(rows.shape[1]):
            place = (total >> np.uint32(24)) ^ np.uint32(rows[row, k])
            total = np.uint32((total << np.uint32(8)) ^ table[np.uintp(place & 0xFF)])
        out[row] = total
    return out
