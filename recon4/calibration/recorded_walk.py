"""A recording with its odometry, cut into windows for calibration."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.tuning_joint import WINDOWS
from recon4.calibration.window import Window, cut_window
from recon4.geometry.se3 import Array, so3_log
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.model.tuning import OBSERVATION
from recon4.progress import Progress, track
from recon4.registration.odometry import Odometry
from recon4.registration.walk_steps import dense_trajectory
from recon4.settings import OdometrySettings
from recon4.settings.reads import OdometryReads
from recon4.store.arrays import load_arrays, load_trajectory
from recon4.store.frames import FrameStore


@dataclass(frozen=True, slots=True, eq=False)
class RecordedWalk:
    """A recording with its odometry."""

    frames: FrameStore
    trajectory: Trajectory
    """``T_odom_body``, dense."""
    lost: NDArray[np.bool_]
    """Multiframes where tracking was lost, (N,)."""
    unobserved: NDArray[np.bool_]
    """Multiframes whose pose along some direction nothing measured, (N,). It follows one of the
    LiDARs there, and the others seem to be off: no window has them."""

    @classmethod
    def of(cls, frames: FrameStore, odometry: Path, settings: OdometrySettings) -> RecordedWalk:
        """A recording with the results of the stage ``odometry``.

        Args:
            frames: The multiframes with IMU and GNSS.
            odometry: Folder of that stage.
            settings: Whether it used the IMU.

        Raises:
            StoreError: If a file is missing or damaged.
        """
        steps = load_arrays(odometry / "steps.npz", ["lost", "weak_sd_m"])
        with_imu = frames.imu is not None and settings.use_imu
        unobserved = (steps["weak_sd_m"] > OBSERVATION.weak_sd_m) & (not with_imu)
        trajectory = load_trajectory(odometry / "trajectory.npz")
        return cls(frames, trajectory, steps["lost"].astype(bool), unobserved)

    @property
    def start_ns(self) -> int:
        """Start of the recording [ns]."""
        return int(self.frames.index["t_ns"][0])

    def with_rig(self, rig: Rig) -> RecordedWalk:
        """The same recording with the mounts and clocks of another rig."""
        return replace(self, frames=self.frames.with_rig(rig))

    def with_all_points(self) -> RecordedWalk:
        """The same recording with the points that the odometry took for moving objects."""
        return replace(self, frames=replace(self.frames, hidden=None))

    def rows(self, count: int, seconds: float, *, with_lost: bool = False) -> list[range]:
        """Multiframes of windows spread over the walk where the body turns most.

        Args:
            count: Largest number of windows.
            seconds: Length of each.
            with_lost: Also where tracking was lost, because the windows will be tracked again.
        """
        t_ns = self.frames.t_mid_ns
        if len(t_ns) < 2:
            return []
        length = max(2, round(seconds / (float(np.median(np.diff(t_ns))) * 1e-9)))
        unusable = self.unobserved if with_lost else self.unobserved | self.lost
        return choose_windows(self.trajectory, t_ns, unusable, count=count, length=length)

    def windows(self, count: int, seconds: float) -> list[Window]:
        """Windows with the trajectory of the odometry."""
        rows = self.rows(count, seconds)
        return [cut_window(self.frames, self.trajectory, part) for part in rows]

    def tracked_freely(self, settings: OdometryReads, progress: Progress) -> Trajectory:
        """``T_odom_body``, dense, of an odometry that no fixes pull."""
        odometry = Odometry(self.frames.rig, settings, self.frames.imu)
        frames = track(self.frames, progress, what="odometry without GNSS", unit="multiframe")
        return dense_trajectory(odometry.push(frame) for frame in frames)

    def tracked_windows(
        self,
        rows: list[range],
        rig: Rig,
        settings: OdometryReads,
        *,
        imu: ImuSamples | None,
        points: int = WINDOWS.points_of_frame,
    ) -> list[Window]:
        """Windows tracked by themselves with another rig, except where tracking is lost.

        Args:
            rows: Multiframes of each window.
            rig: Rig of the odometry; LiDARs that are not enabled do not take part.
            settings: Of the odometry.
            imu: Samples for the odometry; None = without an IMU.
            points: Largest number of points of one sensor in one multiframe.
        """
        found = []
        for part in rows:
            odometry = Odometry(rig, settings, imu)
            steps = [odometry.push(self.frames[row]) for row in part]
            if not any(step.lost for step in steps):
                dense = dense_trajectory(steps)
                found.append(cut_window(self.frames, dense, part, points=points))
        return found


def choose_windows(
    trajectory: Trajectory,
    t_mid_ns: Times,
    unusable: NDArray[np.bool_],
    *,
    count: int,
    length: int,
) -> list[range]:
    """Multiframes of windows spread over the walk, where the body turns most about its axes.

    The walk is divided into equal parts; in each the window is chosen with the largest turning
    about the axis it turns least about. Windows with unusable multiframes are left out.

    Args:
        trajectory: ``T_odom_body``, dense.
        t_mid_ns: Middle of each multiframe [ns], (N,).
        unusable: Multiframes that no window may have, (N,).
        count: Largest number of windows.
        length: Multiframes of a window.
    """
    total = len(t_mid_ns)
    starts = np.arange(0, total - length + 1)
    if len(starts) == 0:
        return []
    excitation = _excitation(trajectory, t_mid_ns, length)
    before = np.concatenate([[0], np.cumsum(unusable)])
    usable = before[starts + length] == before[starts]
    parts = min(count, max(1, total // length))
    edges = np.linspace(0, total, parts + 1).astype(int)
    chosen = []
    for first, last in pairwise(edges):
        inside = usable & (starts >= first) & (starts + length <= max(last, first + length))
        if inside.any():
            best = int(starts[inside][np.argmax(excitation[inside])])
            chosen.append(range(best, best + length))
    return chosen


def _excitation(trajectory: Trajectory, t_mid_ns: Times, length: int) -> Array:
    """Smallest eigenvalue of the summed squares of the turns in each window [rad²]."""
    R = trajectory.at(t_mid_ns, slack_ns=10**9).R
    turn = so3_log(np.swapaxes(R[:-1], -1, -2) @ R[1:])
    squares = np.concatenate(
        [np.zeros((1, 3, 3)), np.cumsum(turn[:, :, None] * turn[:, None, :], axis=0)]
    )
    sums = squares[length - 1 :] - squares[: len(squares) - length + 1]
    return np.asarray(np.linalg.eigvalsh(sums)[:, 0], np.float64)
