"""What the manuals of Ouster say of the sensors, where their metadata does not."""

from __future__ import annotations

import numpy as np

BEAM_ORIGIN_MM = {"OS-0-": 27.67, "OS-1-": 15.806, "OS-2-": 13.762}
"""Start of the product line -> how far from the axis the beams leave, where it is not stated."""
OLDEST_BEAM_ORIGIN_MM = 12.163
LIDAR_HEIGHT_MM, OS2_HEIGHT_MM = 36.18, 74.296
"""Height of the optical center above the base, where it is not stated."""
COLUMNS_PER_TURN = np.array([512, 1024, 2048, 4096])
"""Columns in a revolution that sensors can be set to."""
