"""What is known of a model of LiDAR."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Scanning = Literal["spinning", "solid-state", "rosette"]
"""``spinning``: rings around an axis. ``solid-state``: lines in a limited view. ``rosette``: a
pattern that does not repeat."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LidarFacts:
    """One model."""

    name: str
    """As in rig files."""
    maker: str
    """Family of its packets."""
    beams: int
    """Rings, or lines; 0 = unknown."""
    scanning: Scanning = "spinning"
    elevation_deg: tuple[float, float]
    """Lowest and highest direction above the horizontal plane of the sensor [°]."""
    azimuth_deg: float = 360.0
    """Horizontal field of view [°]."""
    min_range_m: float
    """Nearer returns are not of surfaces [m]."""
    range_m: float
    """Usual range at 10 % reflectivity [m]."""
    range_sd_m: float
    """Standard deviation of a range [m]; half of the accuracy where only that is stated."""
    divergence_rad: float
    """Full angle of a beam in its wider direction [rad]."""
    alike: str = ""
    """Models that are not read and send packets of the same form; nothing tells them apart."""
    port: int = 2368
    """UDP port of its data packets, unless it was set to another."""
    sample_ports: tuple[int, ...] = ()
    """UDP ports of its other packets: IMU, positions, device data."""
    has_imu: bool = False
    """Whether its packets have an IMU."""
    p_sensor_imu_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where the IMU is in the frame of the points [m]; 0 = within a centimeter, or not known."""
    rpy_sensor_imu_deg: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw of its axes in those of the points [°]."""

    @property
    def has_rings(self) -> bool:
        """Whether its points lie on rings: the same elevation again and again."""
        return self.scanning == "spinning"

    @property
    def ring_step_deg(self) -> float:
        """How far neighboring rings are apart on average [°]; 0 = no rings, or not known."""
        if not self.has_rings or self.beams < 2:
            return 0.0
        return (self.elevation_deg[1] - self.elevation_deg[0]) / (self.beams - 1)
