"""Normalizes the intensities of points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.intensity import apply_table
from recon4.model.intensity_table import IntensityTable


def normalized_intensity(
    table: IntensityTable, columns: Mapping[str, NDArray[Any]]
) -> NDArray[np.float32]:
    """Normalized intensities, (N,).

    Args:
        table: Of the sensors of these points.
        columns: ``intensity`` (raw), ``sensor`` (row in the rig), ``ring``, ``incidence_rad``
            (between beam and normal, 0..pi/2, NaN = no normal) and ``range_m`` of the points, (N,).
    """
    out = np.empty(len(columns["intensity"]), np.float32)
    apply_table(
        columns["intensity"],
        columns["sensor"],
        columns["ring"],
        columns["incidence_rad"],
        columns["range_m"],
        table.incidence_bin_rad,
        table.range_bin_m,
        table.gain,
        table.offset,
        table.upper,
        out,
    )
    return out
