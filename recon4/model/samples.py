"""IMU and GNSS samples: structures of arrays, one row per sample."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times


@dataclass(frozen=True, slots=True, eq=False)
class ImuSamples:
    """Gyroscope and accelerometer in the frame of the IMU."""

    t_ns: Times
    """Absolute times [ns], strictly increasing, (N,)."""
    gyro_rad_s: Array
    """Angular rate [rad/s], (N, 3)."""
    accel_m_s2: Array
    """Specific force [m/s²], (N, 3): at rest it points up with 9.8. All-NaN rows = not measured."""

    def __len__(self) -> int:
        return len(self.t_ns)


class GnssQuality(IntEnum):
    """Fix quality, numbered as in NMEA GGA."""

    INVALID = 0
    SINGLE = 1
    DIFFERENTIAL = 2
    RTK_FIXED = 4
    RTK_FLOAT = 5
    DEAD_RECKONING = 6


@dataclass(frozen=True, slots=True, eq=False)
class GnssSamples:
    """Positions of the antenna in WGS 84 / ETRS89, ellipsoidal heights; optional attitudes."""

    t_ns: Times
    """Absolute times [ns], strictly increasing, (N,)."""
    lat_rad: Array
    """Latitude [rad], (N,)."""
    lon_rad: Array
    """Longitude [rad], (N,)."""
    height_m: Array
    """Ellipsoidal height [m], (N,). NaN = not measured (an RMC sentence has none)."""
    sd_enu_m: Array
    """Standard deviations east, north, up [m], (N, 3). NaN = not given."""
    quality: NDArray[np.uint8]
    """`GnssQuality`, (N,)."""
    rpy_ned_rad: Array
    """INS roll, pitch, heading in NED [rad], (N, 3). NaN = not measured."""

    def __len__(self) -> int:
        return len(self.t_ns)

    def take(self, rows: Any) -> GnssSamples:
        """The samples of some rows."""
        return GnssSamples(*(getattr(self, name)[rows] for name in GnssSamples.__slots__))
