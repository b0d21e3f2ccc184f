"""Tuning of registration and odometry."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Literal

from msgspec import Struct

from recon4.settings import OdometrySettings, RegistrationSettings


class SegmentTuning(Struct, frozen=True, kw_only=True):
    """Collar line segments (V §2.4, requirements A3.1; docs/explanation/registration.md)."""

    azimuth_bins: int = 36
    """Cells around the spin axis."""
    generated: int = 20
    """Number of random segments per cell between two neighboring rings."""
    preserved: int = 5
    """Number of the shortest of them that are kept."""
    most_bands: int = 40
    """Bands of elevation between which segments are drawn: 32 rings are bands of their own, those
    of 64 and 128 beams are joined; a VLP-16 has one each 2°, these 40 of a Mid-360 have 1.5°."""
    max_length_per_range: float = 0.34
    """A segment longer than this times the range of its nearer end crosses a depth edge and is
    dropped (a third: 2° between beams, at least 6° of incidence)."""
    seed: int = 4
    """Seed of the random draws; combined with the frame id."""


class OverlapTuning(Struct, frozen=True, kw_only=True):
    """Overlap by a spherical z-buffer
    (V §2.5, requirements A4; docs/explanation/registration.md).
    """

    azimuth_bins: int = 180
    """Bins of a view volume around the vertical axis."""
    elevation_bins: int = 90
    """Bins of a view volume from down to up."""
    min_points: int = 5
    """A bin with fewer points is empty."""
    relative_tolerance: float = 0.1
    """t_r of V Eq. 2.6, read as ``p_r < r_min * (1 + t_r) + t_a`` (A0 no. 2)."""
    absolute_tolerance_m: float = 0.3
    """t_a of V Eq. 2.6 [m]."""
    threshold: float = 0.5
    """t_o: pairs that overlap less are rejected."""
    mode: Literal["target", "source", "min", "harmonic"] = "target"
    """Which points are tested in which buffer; ``target`` is as in the text."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationTuning(RegistrationSettings):
    """Registration of two sets of collar line segments (V §2.4, requirements A3)."""

    max_iterations: int = 20
    """Upper bound on match-and-solve rounds (thesis: 500)."""
    max_move_m: float = 2.5
    """A solution farther from its initial pose has not converged [m, rotation as at 5 m]."""
    converged_step_m: float = 5e-4
    """Stop if a round moves a point at 5 m by less than this [m] (``common_normal``)."""
    max_distance_m: float = 1.0
    """Midpoints farther apart never match [m] (``common_normal``)."""
    kernel_m: float = 0.05
    """Scale of the Cauchy kernel on the line distance [m] (``common_normal``)."""
    portion: float = 0.5
    """Smallest fraction of nearest matches that odometry keeps, even if the overlap is smaller
    (``svd``, ``common_normal``)."""
    error_window: int = 20
    """Rounds over which the error must not change (``svd``)."""
    error_deviation: float = 1e-4
    """Standard deviation of the error in that window below which it has converged (``svd``)."""
    target_error_m: float = 0.01
    """An error below this has converged [m] (``svd``)."""


class PlaneTuning(Struct, frozen=True, kw_only=True):
    """Map of small planes to which segments are registered (docs/explanation/registration.md)."""

    finest_m: float = 0.2
    """Edge of the smallest cubes [m]."""
    levels: int = 4
    """Number of sizes of cubes; each is twice the one before."""
    min_points: int = 8
    """A cube with fewer points has no plane."""
    max_sd_m: float = 0.03
    """Largest standard deviation of the points of a plane across it [m]."""
    point_sd_m: float = 0.02
    """Standard deviation of one measured point [m]."""
    kernel_m: float = 0.02
    """Scale of the Cauchy kernel on the distance from the plane [m]."""


class ScanTuning(Struct, frozen=True, kw_only=True):
    """Registration of two single scans without an IMU (docs/explanation/registration.md)."""

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


SEGMENTS = SegmentTuning()
OVERLAP = OverlapTuning()
PLANES = PlaneTuning()
SCANS = ScanTuning()


@dataclass(frozen=True, slots=True, kw_only=True)
class OdometryTuning(OdometrySettings):
    """Pose of each multiframe from the ones before
    (docs/explanation/odometry.md; requirements A3, A5).
    """

    scans: ScanTuning = SCANS
    """Without an IMU."""
    history_without_imu: int = 10
    """Keyframes in the local map without an IMU, when a longer map holds the body back where
    little is observed."""
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
    gnss_sd_m: float = 0.1
    """Smallest standard deviation of a fix [m]: its errors are correlated over seconds."""
    heading_sd_rad: float = 0.01
    """Standard deviation of the INS heading [rad]."""
    weak_eigenvalue: float = 0.05
    """A direction is weak if the mean squared component of the planes' normals along it is smaller
    (1/3 = isotropic, 0 = unobservable): there single points are registered beside the segments."""
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


_PUBLISHED_ITERATIONS = 500
"""Of the closed form, in the thesis."""


def registration_tuning(settings: RegistrationSettings) -> RegistrationTuning:
    """The tuning of a solver: the closed form has as many rounds as published."""
    if isinstance(settings, RegistrationTuning):
        return settings
    chosen = {field.name: getattr(settings, field.name) for field in fields(settings)}
    if settings.solver == "svd":
        return RegistrationTuning(**chosen, max_iterations=_PUBLISHED_ITERATIONS)
    return RegistrationTuning(**chosen)
