"""Settings of the stage `odometry`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True, kw_only=True)
class OdometrySettings:
    """Pose of each multiframe from the ones before (V §2.4, requirements A3, A5)."""

    history: int = 40
    """Keyframes in the local map; for line odometry the number of past multiframes …"""
    history_without_imu: int = 10
    """… and without an IMU, when a longer map holds the body back where little is observed."""
    history_mode: Literal["joined", "averaged"] = "joined"
    """Line odometry: ``joined`` registers to the lines of the whole history, ``averaged`` to each
    of its multiframes with the mean of the poses (V Table 3.1, multi-frame; the work grows by
    their number)."""
    keyframe_m: float = 0.3
    """A multiframe becomes a keyframe if the body moved by this [m] …"""
    keyframe_rad: float = 0.26
    """… or turned by this [rad] since the last keyframe."""
    rounds: int = 8
    """Upper bound on match-and-solve rounds …"""
    rounds_without_imu: int = 30
    """… and without an IMU, when the first are far off."""
    information_scale: float = 0.02
    """Fraction of the matches that counts as independent: neighbors have the same plane error."""
    use_imu: bool = True
    """Predict and undistort by the IMU if the recording has one."""
    use_gnss: bool = True
    """Aid odometry by GNSS/INS with heading where the LiDAR does not determine the motion."""
    gnss_sd_m: float = 0.1
    """Smallest standard deviation of a fix [m]: its errors are correlated over seconds."""
    heading_sd_rad: float = 0.01
    """Standard deviation of the INS heading [rad]."""
    weak_eigenvalue: float = 0.05
    """A direction is weak if the mean squared component of the planes' normals along it is smaller
    (1/3 = isotropic, 0 = unobservable): there single points are registered beside the segments."""
    leave_out_moving: bool = True
    """Where people or vehicles fill much of the view, register a second time without their points,
    and leave these out of the map."""
    normal_noise_rad: float = 0.03
    """Error of a plane's normal [rad]: directions with no more information than such errors create
    count as unobservable."""
    gyro_noise: float = 3e-4
    """Noise density of the gyroscope [rad/s/sqrt(Hz)]."""
    accel_noise: float = 1e-2
    """Noise density of the accelerometer [m/s²/sqrt(Hz)]."""
    gyro_bias_walk: float = 1e-4
    """Random walk of the gyroscope's bias [rad/s/sqrt(s)]."""
    accel_bias_walk: float = 1e-3
    """Random walk of the accelerometer's bias [m/s²/sqrt(s)]."""
    gyro_gain_sd: float = 0.01
    """Standard deviation of the gyroscope's scale and of the angles of its axes [1]; the odometry
    estimates them. 0 = they are as the rig file says."""
    imu_clock_sd_s: float = 0.005
    """Standard deviation of the clock of the IMU against that of the LiDARs [s]; the odometry
    estimates it. 0 = it is as the rig file says."""
    free_turn_walk: float = 3.0
    """Without an IMU: random walk of the turn rate [rad/s/sqrt(s)]."""
    free_accel: float = 2.0
    """Without an IMU: random walk of the velocity [m/s/sqrt(s)]."""
    line_sd_m: float = 0.01
    """Standard deviation of the motion over a multiframe by line odometry [m] …"""
    line_sd_rad: float = 0.002
    """… and of its rotation [rad]."""
    restart_after: int = 10
    """With an IMU: number of lost multiframes after which the local map is reset."""
    lost_error_m: float = 0.1
    """With a larger error tracking is lost [m]."""
    lost_match_ratio: float = 0.3
    """With a smaller match ratio tracking is lost …"""
    lost_usual_ratio: float = 0.5
    """… or below this part of the sensor's usual match ratio, whichever is less …"""
    lost_after_frames: int = 10
    """… which is known after this many frames."""
    lost_least_ratio: float = 0.1
    """The least match ratio, whatever is usual; it is enough at the start of a walk for a scan that
    lies where the IMU predicts it, and without an IMU for one that fits the scan before."""

    def longest_map(self, *, with_imu: bool) -> int:
        """Keyframes in the local map, with or without an IMU."""
        return self.history if with_imu else min(self.history, self.history_without_imu)


@dataclass(frozen=True, slots=True, kw_only=True)
class ScanSettings:
    """Registration of two single scans: prediction and relocalization without an IMU."""

    voxel_m: float = 0.25
    """Edge of the voxels to which scans are thinned [m]."""
    neighbors: int = 12
    """Number of points from which a normal is computed, the point itself included."""
    source_points: int = 20_000
    """Largest number of points of the source."""
    gate_m: float = 0.7
    """Points farther apart never match [m]; three times as far in the first two rounds."""
    kernel_m: float = 0.3
    """Scale of the Cauchy kernel on the symmetric distance [m]."""
    rounds: int = 30
    """Upper bound on match-and-solve rounds."""
    inlier_m: float = 0.1
    """Largest distance of an inlier from its plane [m]."""
    min_inlier_ratio: float = 0.3
    """With a smaller inlier ratio the registration has not converged."""
    confident_inlier_ratio: float = 0.45
    """With a smaller inlier ratio other initial poses are tried."""
    sure_scans: int = 10
    """After tracking was lost a new map begins when this many scans in a row fit each other."""
    bridge_s: float = 10.0
    """After a gap the walk goes on if a scan surely lies on those of the last this many seconds
    [s]; later the body may be on a storey that looks the same. 0 = never."""
    starts: int = 10
    """Number of overlays of the ground plans that are tried."""
