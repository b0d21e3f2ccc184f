"""Whether an IMU is mounted otherwise than its rig says, as the turns of the LiDARs show.

A rig that is written by hand or a driver that states another frame exchanges axes: the IMU hangs
upside down, or its x axis points to the left. The LiDARs alone track the stretch that turns about
most axes; the rotation that makes the gyroscope measure the same turns is found from any start.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_log
from recon4.model.frames import RecordedFrames
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.gyro_alignment import compare_turns
from recon4.registration.odometry import Odometry
from recon4.registration.tuning_imu import TURNED_IMU
from recon4.settings.reads import OdometryReads

_QUARTER_TURNS = np.array(
    [
        R
        for axes, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3))
        if np.linalg.det(R := np.diag(signs)[list(axes)]) > 0.0
    ]
)
"""All rotations of axes into axes, (24, 3, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class TurnedImu:
    """How an IMU is mounted otherwise than its rig says."""

    R: Array
    """Turns what it measures into the axes that the rig states, (3, 3)."""
    explained: float
    """Part of the turns of the LiDARs that its gyroscope measures by the rig …"""
    explained_turned: float
    """… and when it is turned, 0..1."""

    @property
    def angle_rad(self) -> float:
        """Angle of the rotation."""
        return float(np.linalg.norm(so3_log(self.R)))


def turned_imu(frames: RecordedFrames, settings: OdometryReads) -> TurnedImu | None:
    """How an IMU is turned against its rig; None = it is not, or nothing shows it surely.

    Args:
        frames: The multiframes with their rig and IMU.
        settings: Of the odometry.
    """
    imu = frames.imu
    if imu is None or len(imu) < 2 or not settings.odometry.use_imu:
        return None
    odometry = Odometry(frames.rig, settings)
    pushed = (odometry.push(frames[k]) for k in _most_turns(frames.t_mid_ns, imu))
    steps = [step for step in pushed if not step.lost]
    if len(steps) < 2:
        return None
    t_ns = np.array([step.t_mid_ns for step in steps], np.int64)
    walk = Trajectory(t_ns, SE3.stack(step.T_odom_body for step in steps))
    turns = compare_turns(walk, t_ns, imu)
    if turns is None:
        return None
    found, R_body_imu = turns.aligned(), frames.rig.T_body_imu.R
    as_stated = turns.explained_by(R_body_imu)
    R = _near_quarter_turn(R_body_imu.T @ found.R_body_imu)
    sure = (
        not found.mirrored
        and found.explained > TURNED_IMU.least_explained
        and 1.0 - as_stated > TURNED_IMU.more_left * (1.0 - found.explained)
        and turns.rotation_sd_rad(found.explained) < TURNED_IMU.most_sd_rad
    )
    turned = TurnedImu(R, as_stated, found.explained)
    return turned if sure and turned.angle_rad > TURNED_IMU.far_rad else None


def _most_turns(t_mid_ns: Times, imu: ImuSamples) -> range:
    """The multiframes in which the gyroscope turns most about two axes."""
    size = min(TURNED_IMU.frames, len(t_mid_ns))
    starts = np.arange(0, len(t_mid_ns) - size + 1, max(size // 4, 1))
    cuts = np.searchsorted(imu.t_ns, np.stack([t_mid_ns[starts], t_mid_ns[starts + size - 1]]))
    second = [
        np.linalg.eigvalsh(np.cov(imu.gyro_rad_s[a:b].T))[1] if b - a > size else 0.0
        for a, b in cuts.T.tolist()
    ]
    first = int(starts[int(np.argmax(second))])
    return range(first, first + size)


def _near_quarter_turn(R: Array) -> Array:
    """Axes that are exchanged, if they nearly are: what is left the filter finds."""
    off_rad = np.linalg.norm(so3_log(np.swapaxes(_QUARTER_TURNS, 1, 2) @ R), axis=1)
    nearest = int(np.argmin(off_rad))
    return _QUARTER_TURNS[nearest] if off_rad[nearest] < TURNED_IMU.same_rad else R
