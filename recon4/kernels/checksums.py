"""Kernel for the checksums of Hesai's packets."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def crc32_of(row: NDArray[np.uint8], tables: NDArray[np.uint32]) -> np.uint32:
    """CRC-32 of bytes, highest bit first, four of them in a step.

    Args:
        row: Bytes, (K,).
        tables: What each byte changes, with 0 to 3 bytes behind it, (4, 256).
    """
    total, low, whole = np.uint32(0xFFFFFFFF), np.uint32(0xFF), len(row) // 4
    for k in range(0, 4 * whole, 4):
        for byte in range(4):
            total ^= np.uint32(row[k + byte]) << np.uint32(24 - 8 * byte)
        high = tables[3, total >> np.uint32(24)] ^ tables[2, (total >> np.uint32(16)) & low]
        total = high ^ tables[1, (total >> np.uint32(8)) & low] ^ tables[0, total & low]
    for k in range(4 * whole, len(row)):
        place = (total >> np.uint32(24)) ^ np.uint32(row[k])
        total = np.uint32((total << np.uint32(8)) ^ tables[0, place & low])
    return total


@njit(cache=True, nogil=True, error_model="numpy")
def crc32_of_rows(rows: NDArray[np.uint8], tables: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """`crc32_of` each row, (N,).

    Args:
        rows: Bytes, (N, K).
        tables: As of `crc32_of`, (4, 256).
    """
    out = np.empty(len(rows), np.uint32)
    for k in range(len(rows)):
        out[k] = crc32_of(rows[k], tables)
    return out
