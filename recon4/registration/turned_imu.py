"""Which axes an IMU has, where they are not those of its rig, as the motion of the LiDARs shows.

A rig that is written by hand or a driver that states another frame exchanges axes: the IMU hangs
upside down, or its x axis points to the left. A driver may also turn signs round: axes are
left-handed, or one of the two sensors has the wrong sign. The LiDARs alone track the stretch that
turns about most axes; what makes the gyroscope measure the same turns is found from any start, and
then the axes of the accelerometer that make its forces change the speed as the LiDARs do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_log
from recon4.model.frames import RecordedFrames
from recon4.model.imu_repair import ImuRepair
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.gyro_alignment import ComparedTurns, GyroAlignment, compare_turns
from recon4.registration.motion import imu_in_body
from recon4.registration.odometry import Odometry
from recon4.registration.reversed_forces import changes_of_speed, is_covered
from recon4.registration.step import OdometryStep
from recon4.registration.tuning_imu import TURNED_IMU
from recon4.settings.reads import OdometryReads

_AXES_INTO_AXES = np.array(
    [
        np.diag(signs)[list(axes)]
        for axes, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3))
    ]
)
"""All maps of axes into axes, right-handed and left-handed, (48, 3, 3); the first is none."""


@dataclass(frozen=True, slots=True, eq=False)
class TurnedImu:
    """Axes of an IMU that are not those of its rig."""

    repair: ImuRepair
    """Makes its samples those of an IMU as the rig states it."""
    explained: float
    """Part of the turns of the LiDARs that its gyroscope measures by the rig …"""
    explained_turned: float
    """… and when it is repaired, 0..1."""

    @property
    def mount(self) -> Array:
        """The rotation that the rig lacks, (3, 3).

        What else is wrong are axes that the driver exchanges: `ImuRepair` is that, and then this.
        """
        gyro, accel = self.repair.gyro, self.repair.accel
        if np.linalg.det(gyro) > 0.0:
            return gyro
        if np.linalg.det(accel) > 0.0:
            return accel
        return np.eye(3) if (gyro == np.rint(gyro)).all() else -gyro

    @property
    def of_driver(self) -> ImuRepair:
        """Axes and signs that the driver must exchange."""
        back = self.mount.T
        return ImuRepair(np.rint(back @ self.repair.gyro), np.rint(back @ self.repair.accel))


def turned_imu(frames: RecordedFrames, settings: OdometryReads) -> TurnedImu | None:
    """Axes of an IMU that are not those of its rig; None = they are, or nothing shows it surely.

    Args:
        frames: The multiframes with their rig and IMU.
        settings: Of the odometry.
    """
    imu = frames.imu
    if imu is None or len(imu) < 2 or not settings.odometry.use_imu:
        return None
    odometry = Odometry(frames.rig, settings)
    pushed = (odometry.push(frames[k]) for k in _most_turns(frames.t_mid_ns, imu))
    return turned_by([step for step in pushed if not step.lost], imu, frames.rig)


def turned_by(steps: Sequence[OdometryStep], imu: ImuSamples, rig: Rig) -> TurnedImu | None:
    """Axes of an IMU that are not those of its rig; None = they are, or nothing shows it surely.

    Args:
        steps: Of an odometry that does not use what may be wrong with the IMU; none is lost.
        imu: Its samples.
        rig: Where it is said to be.
    """
    if len(steps) < 2:
        return None
    t_ns = np.array([step.t_mid_ns for step in steps], np.int64)
    walk = Trajectory(t_ns, SE3.stack(step.T_odom_body for step in steps))
    turns = compare_turns(walk, t_ns, imu)
    if turns is None:
        return None
    R_body_imu = rig.T_body_imu.R
    found = _of_any_hand(turns)
    if not _is_known(turns, found):
        return None
    gyro = _simplest(turns, found, R_body_imu)
    accel = _of_forces(steps, _while_tracked(imu, t_ns, found.clock_s), rig, gyro=gyro)
    if np.array_equal(gyro, np.eye(3)) and np.array_equal(accel, np.eye(3)):
        return None
    return TurnedImu(ImuRepair(gyro, accel), turns.explained_by(R_body_imu), found.explained)


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


def _of_any_hand(turns: ComparedTurns) -> GyroAlignment:
    """The rotation that explains the most, or a reflection if that explains clearly more."""
    rotated, reflected = turns.aligned(), turns.aligned(left_handed=True)
    return reflected if _exceeds(turns, reflected.explained, rotated.explained) else rotated


def _is_known(turns: ComparedTurns, found: GyroAlignment) -> bool:
    return (
        found.explained > TURNED_IMU.least_explained
        and turns.rotation_sd_rad(found.explained) < TURNED_IMU.most_sd_rad
    )


def _simplest(turns: ComparedTurns, found: GyroAlignment, R_body_imu: Array) -> Array:
    """None, exchanged axes, or what was found: the first that explains as much, (3, 3)."""
    R = R_body_imu.T @ found.R_body_imu
    same_hand = _AXES_INTO_AXES[np.linalg.det(_AXES_INTO_AXES) * np.linalg.det(R) > 0.0]
    off_rad = np.linalg.norm(so3_log(np.swapaxes(same_hand, 1, 2) @ R), axis=1)
    nearest = same_hand[int(np.argmin(off_rad))]
    explained = turns.explained_by(R_body_imu @ nearest)
    far = off_rad.min() > TURNED_IMU.far_rad and _exceeds(turns, found.explained, explained)
    return R if far else nearest


def _exceeds(turns: ComparedTurns, explained: float, simpler: float) -> bool:
    return turns.log_likelihood_ratio(explained, simpler) > TURNED_IMU.sigmas**2


def _while_tracked(imu: ImuSamples, t_ns: Times, clock_s: float) -> ImuSamples:
    """Samples between the first and the last multiframe, by the clock of the LiDARs."""
    imu_ns = imu.t_ns + round(1e9 * clock_s)
    rows = (imu_ns >= t_ns[0]) & (imu_ns <= t_ns[-1])
    return ImuSamples(imu_ns[rows], imu.gyro_rad_s[rows], imu.accel_m_s2[rows])


def _of_forces(steps: Sequence[OdometryStep], imu: ImuSamples, rig: Rig, *, gyro: Array) -> Array:
    """Axes of the accelerometer, (3, 3): those of the gyroscope if nothing else is sure.

    Along each axis of the walk its forces change the speed as the LiDARs do, beside an error of
    one size.
    """
    if not is_covered(steps, imu.t_ns):
        return gyro
    misfits = []
    for exchanged in _AXES_INTO_AXES:
        accel = imu_in_body(ImuRepair(gyro, gyro @ exchanged).of(imu), rig)[1]
        felt, seen = changes_of_speed(steps, imu.t_ns, accel)
        misfits.append(len(seen) * float(np.log(((felt - seen) ** 2).sum(axis=0)).sum()))
    best, second = np.argsort(misfits)[:2]
    is_sure = misfits[second] - misfits[best] > TURNED_IMU.sigmas**2
    return gyro @ _AXES_INTO_AXES[best] if is_sure else gyro
