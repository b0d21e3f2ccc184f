"""Tags of points of Livox LiDARs, as columns; `recon4.kernels.livox` reads those of packets."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def is_noise(tag: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Tags of noise of high confidence, by position (bits 0-1) or intensity (bits 2-3), (N,)."""
    return ((tag & 0x03) == 0x01) | ((tag & 0x0C) == 0x04)


def echo_of_tag(tag: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """1 for second and third returns, (N,). Bits 4-5 count from 1; 0 is one near the window."""
    return (((tag >> 4) & 0x03) > 1).astype(np.uint8)
