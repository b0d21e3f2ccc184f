"""Settings of the stage `frames`: reading a recording."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from recon4.settings.require import Checked, ValueRange, require


@dataclass(frozen=True, slots=True, kw_only=True)
class IngestSettings(Checked):
    """Reading a recording into multiframes."""

    rate_hz: Annotated[float, ValueRange(0, 100, "Hz")] = 0.0
    """Multiframes per second. 0 = one per measured revolution of the slowest LiDAR."""
    min_range_m: Annotated[float, ValueRange(0, 1000, "m")] = 0.7
    """Nearer returns are of the carrier and are dropped [m]."""
    max_range_m: Annotated[float, ValueRange(0, 1000, "m")] = 120.0
    """Farther returns are dropped [m]."""
    deskewed: bool = False
    """The clouds are undistorted already, or the sensor stood still: all points are taken as
    measured at the cloud's stamp. For terrestrial laser scans and clouds of other programs."""
    as_measured: bool = False
    """The clouds are as their sensor measured them, although they look like clouds that a program
    has put into the frame of its map: they are not refused for it."""
    points_unit_m: Annotated[float, ValueRange(1e-6, 1e3, "m")] = 1.0
    """Unit of the points of clouds [m]: 0.001 if they are in millimeters."""

    lidar_topic: str = ""
    """Topic of the only LiDAR of a bag that is read; of its 2-D laser in a bag of lasers alone.
    Empty = chosen by content, or by the rig."""
    imu_gyro_unit: Literal["auto", "rad_s", "deg_s"] = "auto"
    """Unit of the angular rates of the IMU in the recording: rad/s or deg/s. auto = by content."""
    imu_topic: str = ""
    """Topic of the IMU in a bag. Empty = that of the rig file, else chosen by content."""
    gnss_topic: str = ""
    """Topic of the positions in a bag. Empty = that of the rig file, else chosen by content."""
    odometry_topic: str = ""
    """Topic of the poses in a bag. Empty = chosen by content."""

    def check(self) -> None:
        """Limits of the range in their order; multiframes not longer than the times of points."""
        # Points have their times from the start of a multiframe in 32 bits: 2.1 s.
        require(
            self.rate_hz == 0.0 or self.rate_hz >= 0.5,
            "rate",
            self.rate_hz,
        )
        require(
            self.min_range_m < self.max_range_m,
            "ranges",
            self.min_range_m,
        )
