"""LZF decompression, the compression of ``binary_compressed`` PCD files."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True)
def lzf_decompress(packed: NDArray[np.uint8], out: NDArray[np.uint8]) -> int:
    """Unpack into ``out``.

    Args:
        packed: Compressed bytes, (M,).
        out: Where to; its size is the expected one, (N,).

    Returns:
        Bytes written, or -1 when the bytes are not LZF or do not fit into ``out``.
    """
    i, o = 0, 0
    while i < packed.size:
        control = int(packed[i])
        i += 1
        if control < 32:
            count = control + 1
            if i + count > packed.size or o + count > out.size:
                return -1
            for _ in range(count):
                out[o] = packed[i]
                o += 1
                i += 1
            continue
        count = control >> 5
        if count == 7:
            if i >= packed.size:
                return -1
            count += int(packed[i])
            i += 1
        if i >= packed.size:
            return -1
        source = o - ((control & 31) << 8) - int(packed[i]) - 1
        i += 1
        count += 2
        if source < 0 or o + count > out.size:
            return -1
        for _ in range(count):
            out[o] = out[source]
            o += 1
            source += 1
    return o
