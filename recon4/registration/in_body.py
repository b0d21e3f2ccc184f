"""Points of a sensor in the body."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.points import transform_points
from recon4.model.rig import Sensor


def in_body(sensor: Sensor, xyz: NDArray[Any]) -> Array:
    """Points of a sensor, float32 (N, 3), in the body, (N, 3) [m]."""
    p_body = np.empty((len(xyz), 3))
    T = sensor.T_body_sensor
    transform_points(np.ascontiguousarray(T.R), T.t, np.ascontiguousarray(xyz), p_body)
    return p_body
