"""Settings of the stage `odometry`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True, kw_only=True)
class OdometrySettings:
    """Pose of each multiframe from the ones before (V §2.4, requirements A3, A5)."""

    history: int = 10
    """Keyframes in the local map; multiframes that line odometry looks back on."""
    history_mode: Literal["joined", "averaged"] = "joined"
    """Line odometry: ``joined`` registers to the lines of the history together, ``averaged`` to
    each of them, the mean of the poses being taken (V Table 3.1, multi-frame; as many times the
    work)."""
    keyframe_m: float = 0.3
    """A multiframe joins the local map once the body moved so far [m] …"""
    keyframe_rad: float = 0.26
    """… or turned so far [rad] since the last that did."""
    rounds: int = 8
    """Upper bound on match-and-solve rounds."""
    information_scale: float = 0.02
    """Share of the matches counted as independent: neighbors see the same plane's error."""
    use_imu: bool = True
    """Predict and undistort with the IMU when the recording has one."""
    use_gnss: bool = True
    """Let GNSS/INS with heading hold odometry where the LiDAR cannot."""
    gnss_sd_m: float = 0.1
    """Smallest standard deviation given to a fix [m]: its errors are alike for seconds."""
    heading_sd_rad: float = 0.01
    """Standard deviation given to a heading of the INS [rad]."""
    normal_noise_rad: float = 0.03
    """Error of a plane's normal [rad]: directions that are held no better than by such errors
    count as free."""
    gyro_noise: float = 3e-4
    """Noise density of the gyroscope [rad/s/sqrt(Hz)]."""
    accel_noise: float = 1e-2
    """Noise density of the accelerometer [m/s²/sqrt(Hz)]."""
    gyro_bias_walk: float = 1e-4
    """Random walk of the gyroscope's bias [rad/s/sqrt(s)]."""
    accel_bias_walk: float = 1e-3
    """Random walk of the accelerometer's bias [m/s²/sqrt(s)]."""
    free_turn_walk: float = 3.0
    """Without an IMU: random walk of the turn rate [rad/s/sqrt(s)]."""
    free_accel: float = 2.0
    """Without an IMU: random walk of the velocity [m/s/sqrt(s)]."""
    line_sd_m: float = 0.01
    """Standard deviation of the motion over a multiframe by line odometry [m] …"""
    line_sd_rad: float = 0.002
    """… and of its rotation [rad]."""
    restart_after: int = 10
    """With an IMU: after so many lost multiframes a new local map is begun."""
    lost_error_m: float = 0.1
    """A larger error means lost [m]."""
    lost_match_ratio: float = 0.3
    """With a smaller ratio of matched segments tracking is lost."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ScanSettings:
    """Registration of two single scans: the first guess and the recovery without an IMU."""

    voxel_m: float = 0.25
    """Scans are thinned to one point in a cube of this edge [m]."""
    neighbors: int = 12
    """Points whose plane gives a point its normal, itself included."""
    source_points: int = 20_000
    """Of the source no more points than this are used."""
    gate_m: float = 0.7
    """Points farther apart never match [m]; three times as far in the first two rounds."""
    kernel_m: float = 0.3
    """Scale of the Cauchy kernel on the symmetric distance [m]."""
    rounds: int = 30
    """Upper bound on match-and-solve rounds."""
    inlier_m: float = 0.1
    """A point this near to its plane lies on it [m]."""
    min_inlier_ratio: float = 0.3
    """With a smaller ratio of inliers the registration has not converged."""
    confident_inlier_ratio: float = 0.45
    """With a smaller ratio of inliers other initial poses are tried."""
    starts: int = 10
    """Overlays of the ground plans that are tried."""
