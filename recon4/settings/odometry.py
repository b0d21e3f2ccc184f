"""Settings of the stage `odometry`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from recon4.settings.require import Checked, ValueRange


@dataclass(frozen=True, slots=True, kw_only=True)
class OdometrySettings(Checked):
    """Pose of each multiframe from the ones before (V §2.4, requirements A3, A5)."""

    use_imu: bool = True
    """Predict and undistort by the IMU if the recording has one."""
    use_gnss: bool = True
    """Aid odometry by GNSS/INS with heading where the LiDAR does not determine the motion."""
    leave_out_moving: bool = True
    """Where people or vehicles fill much of the view, register a second time without their points,
    and leave these out of the map."""
    history: Annotated[int, ValueRange(1, 1000)] = 40
    """Keyframes in the local map; for line odometry the number of past multiframes."""
    history_mode: Literal["joined", "averaged"] = "joined"
    """Line odometry: ``joined`` registers to the lines of the whole history, ``averaged`` to each
    of its multiframes with the mean of the poses (V Table 3.1, multi-frame; the work grows by
    their number)."""
    line_sd_rad: Annotated[float, ValueRange(1e-5, 1, "rad")] = 0.002
    """Standard deviation of the rotation over a multiframe by line odometry [rad]."""
