"""Classes of points by what is around them: noise."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.mapping.surface_fit import FittedSurfaces
from recon4.model.classes import PointClass


def mark_noise(classes: NDArray[np.uint8], surfaces: FittedSurfaces, min_neighborhood: int) -> None:
    """Mark stray returns: high noise if nothing else is around them, else low noise.

    Args:
        classes: Of all points; those of unclassified ones may change, (N,).
        surfaces: Of the points.
        min_neighborhood: Points with fewer in their neighborhood are noise.
    """
    open_ = classes == PointClass.UNCLASSIFIED
    stray = open_ & (surfaces.stray | (surfaces.support < min_neighborhood))
    rows = np.flatnonzero(stray)
    # Too few others around it for a normal: nothing else was measured there.
    alone = ~surfaces.surfaces[surfaces.surface_of[rows], :3].any(axis=1)
    classes[rows] = np.where(alone, PointClass.HIGH_NOISE, PointClass.LOW_NOISE)
