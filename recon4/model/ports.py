"""UDP ports of samples and scans where a rig file says none (``docs/how-to/live.md``)."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class UsualPorts:
    """Next to Velodyne's 2368 (data) and 8308 (positions).

    The port of a LiDAR is in `recon4.model.lidars`.
    """

    imu: int = 8309
    gnss: int = 8310
    laser2d: int = 8311
    profiler: int = 8312


PORTS = UsualPorts()
