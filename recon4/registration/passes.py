"""One pass of the odometry over all multiframes, and the dense trajectory that it leaves."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, proper, so3_exp, so3_log
from recon4.model.events import PosesAdded, TrackingLost, positions_of
from recon4.model.frames import RecordedFrames
from recon4.model.odometry_figures import ImuChoice
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.progress import Progress, track
from recon4.registration.aiding import GnssAiding
from recon4.registration.imu_consistency import consistent_imu
from recon4.registration.imu_estimate import ImuEstimate
from recon4.registration.line_odometry import LineOdometry
from recon4.registration.make import make_odometry
from recon4.registration.motion import middle_of
from recon4.registration.moving_start import LONGEST_NS, MOVING_M_S
from recon4.registration.odometry import Odometry
from recon4.registration.step import OdometryStep
from recon4.settings import Settings

_REPORT_EVERY, _REPORT_AT_ONCE = 5, 4
"""The pose of every n-th multiframe is reported while the stage runs, some per event."""
_AS_WELL = 1.02
"""Residuals that are larger by no more than this factor are as good."""
_MOST_TURN_RAD, _MOST_SHIFT_M = 2e-3, 5e-3
"""A larger jump from one multiframe to the next is a contradiction, and stays where it is."""
_DENSE_NS = 9_000_000
"""Poses of the dense trajectory are at least this far apart [ns] (at most about 100 Hz)."""


@dataclass(frozen=True, slots=True, eq=False)
class OdometryPass:
    """Odometry of all multiframes, and what was found out about the IMU meanwhile."""

    steps: list[OdometryStep]
    trajectory: Trajectory
    """``T_odom_body``, dense."""
    imu: ImuSamples | None
    """As it was used; None = not."""
    imu_choice: ImuChoice
    """Which samples were used, from the trial before any multiframe is registered."""
    estimate: ImuEstimate | None

    @property
    def lost(self) -> int:
        """Multiframes where tracking was lost."""
        return sum(step.lost for step in self.steps)

    @property
    def pieces(self) -> NDArray[np.int64]:
        """Number of the piece of each multiframe, -1 = lost, (N,)."""
        return np.array([-1 if step.lost else step.piece for step in self.steps], np.int64)

    def fits_as_well(self, other: OdometryPass) -> bool:
        """Whether it loses no more multiframes, and what matches lies as near."""
        mine, others = (np.array([s.error_m for s in one.steps]) for one in (self, other))
        both = np.isfinite(mine) & np.isfinite(others)
        return self.lost <= other.lost and bool(mine[both].sum() <= _AS_WELL * others[both].sum())


def register_all(
    frames: RecordedFrames,
    settings: Settings,
    *,
    progress: Progress,
    aiding: GnssAiding | None = None,
    trusted: bool = False,
) -> OdometryPass:
    """Register all multiframes; again with a corrected IMU, if it proved to be wrong.

    Until the scale, the axes and the clock of an IMU are known the trajectory errs by them.

    Args:
        frames: The multiframes with their rig and IMU.
        settings: Of the odometry.
        progress: Counts multiframes; tracking that is lost is an event.
        aiding: Fixes of a GNSS/INS, outdoors.
        trusted: Whether the IMU is, see `consistent_imu`.
    """
    imu, choice = consistent_imu(frames, settings, trusted=trusted)

    def made_by(odometry: Odometry | LineOdometry) -> OdometryPass:
        steps = _without_jumps(_register(frames, odometry, progress))
        estimate = odometry.imu_estimate if isinstance(odometry, Odometry) else None
        used = imu if settings.odometry.use_imu else None
        return OdometryPass(steps, dense_trajectory(steps), used, choice, estimate)

    odometry = make_odometry(frames.rig, settings, imu, aiding=aiding)
    made = made_by(odometry)
    if not isinstance(odometry, Odometry) or not (made.estimate and made.estimate.faults):
        return made
    again = Odometry(frames.rig, settings, imu, aiding=aiding)
    again.remember_imu(odometry)
    corrected = made_by(again)
    return corrected if corrected.fits_as_well(made) else made


def _register(
    frames: RecordedFrames, odometry: Odometry | LineOdometry, progress: Progress
) -> list[OdometryStep]:
    """Register all multiframes in order, and report the growing trajectory."""
    steps: list[OdometryStep] = []
    for frame in track(frames, progress, what="odometry", unit="multiframe"):
        step = odometry.push(frame)
        if step.lost:
            progress.event(TrackingLost(frame_id=step.frame_id, t_ns=step.t_mid_ns))
        steps.append(step)
        if len(steps) % (_REPORT_EVERY * _REPORT_AT_ONCE) == 0:
            _report_poses(steps[-_REPORT_EVERY * _REPORT_AT_ONCE :: _REPORT_EVERY], progress)
    return steps


def _report_poses(steps: list[OdometryStep], progress: Progress) -> None:
    """Report some poses as an event, for a display of the growing trajectory."""
    T = SE3.stack(step.T_odom_body for step in steps)
    quaternions = np.round(T.quat_xyzw(), 5).tolist()
    progress.event(
        PosesAdded(
            t_ns=tuple(step.t_mid_ns for step in steps),
            t_m=positions_of(T.t),
            quat_xyzw=tuple((x, y, z, w) for x, y, z, w in quaternions),
        )
    )


def dense_trajectory(steps: list[OdometryStep]) -> Trajectory:
    """The dense poses of all steps as one trajectory, at most about 100 Hz."""
    steps = _without_jumps(_begun_in_motion(steps))
    t_ns = np.concatenate([step.t_ns for step in steps])
    R = np.concatenate([step.T_dense.R for step in steps])
    t_m = np.concatenate([step.T_dense.t for step in steps])
    # The first pose of a frame updates the last pose of the frame before.
    newest = len(t_ns) - 1 - np.unique(t_ns[::-1], return_index=True)[1]
    t_ns, R, t_m = t_ns[newest], R[newest], t_m[newest]
    slot = (t_ns - t_ns[0]) // _DENSE_NS
    kept = np.append(np.diff(slot) > 0, True)
    kept[0] = True
    return Trajectory(t_ns[kept], SE3(R[kept], t_m[kept]))


def _begun_in_motion(steps: list[OdometryStep]) -> list[OdometryStep]:
    """The steps with a first frame that moves as fast as the second one begins.

    The velocity at the start is known only with the second frame, when the poses inside the first
    one were already reported: half a frame of a walk puts them 6 cm beside their places.
    """
    if len(steps) < 2 or len(steps[0].t_ns) < 2 or steps[1].lost:
        return steps
    first, second = steps[:2]
    span_ns = second.t_mid_ns - first.t_mid_ns
    if second.piece != first.piece or not 0 < span_ns <= LONGEST_NS:
        return steps
    # Both at the end of the first frame; what the IMU measured inside it stays.
    there = (second.T_odom_body.t - first.T_odom_body.t) / (1e-9 * span_ns)
    reported = (first.T_dense.t[-1] - first.T_dense.t[-2]) / (1e-9 * np.diff(first.t_ns)[-1])
    missing = there - reported
    if float(np.linalg.norm(missing)) < MOVING_M_S:
        return steps
    since_s = 1e-9 * (first.t_ns - first.t_mid_ns)
    moving = SE3(first.T_dense.R, first.T_dense.t + since_s[:, None] * missing)
    return [replace(first, T_dense=moving), *steps[1:]]


def _without_jumps(steps: list[OdometryStep]) -> list[OdometryStep]:
    """The steps with inner poses that lead to where the next one begins.

    The next multiframe corrects the pose between both, by up to a millimeter. What it says of the
    end is true of the motion that led there, in proportion to the time: a jump in the last 10 ms
    of every revolution would always meet the same azimuths. How the first multiframe began is not
    known better than by itself.
    """
    if len(steps) < 3:
        return steps
    return [steps[0], *(_led_to(step, after) for step, after in pairwise(steps[1:])), steps[-1]]


def _led_to(step: OdometryStep, after: OdometryStep) -> OdometryStep:
    if step.lost or after.lost or step.piece != after.piece or step.t_ns[-1] != after.t_ns[0]:
        return step
    T, begin = step.T_dense, after.T_dense[0]
    part = ((step.t_ns - step.t_ns[0]) / max(1, int(step.t_ns[-1] - step.t_ns[0])))[:, None]
    turn, shift = so3_log(begin.R @ T.R[-1].T), begin.t - T.t[-1]
    if np.linalg.norm(turn) > _MOST_TURN_RAD or np.linalg.norm(shift) > _MOST_SHIFT_M:
        return step
    led = SE3(proper(so3_exp(part * turn) @ T.R), T.t + part * shift)
    t_s = 1e-9 * (step.t_ns - step.t_ns[0])
    return replace(step, T_dense=led, T_odom_body=middle_of(t_s, led))
