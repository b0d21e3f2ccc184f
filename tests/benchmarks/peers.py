"""Odometry of other projects on a frame store, for comparison in the same run.

    python -m tests.benchmarks.peers FRAMES_FOLDER TRUTH.tum

KISS-ICP and small_gicp VGICP, each as it comes and with frames deskewed and predicted by the
gyroscope. One thread, one core; the time of the deskew is counted apart.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.evaluation.table import number, text_table
from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.recording.formats.poses import read_tum
from recon4.store.frames import FrameStore

VOXEL_M = 0.25
"""KISS-ICP's voxels indoors (its default of a hundredth of the range is for streets)."""
MIN_RANGE_M, MAX_RANGE_M = 0.5, 60.0
_KNOTS = 40


@dataclass(frozen=True, slots=True, eq=False)
class PeerRun:
    """Result of a peer for a recording."""

    name: str
    trajectory: Trajectory
    """One pose a multiframe, at its middle (KISS-ICP's own deskew: at its end)."""
    register_s: Array
    """Time of each registration, preprocessing included [s], (N,)."""
    deskew_s: Array
    """Time of our gyroscope deskew of each frame [s], (N,)."""


Register = Callable[[Array, Array, Array | None], Array]
"""Points in the body (N, 3), times 0..1 (N,), rotation since the frame before (3, 3) or None
-> ``T_odom_body`` (4, 4)."""


def kiss_icp(*, deskew: bool, voxel_m: float = VOXEL_M) -> Register:
    """KISS-ICP with indoor settings on one thread."""
    from kiss_icp.config import KISSConfig
    from kiss_icp.kiss_icp import KissICP

    config = KISSConfig()
    config.data.max_range, config.data.min_range = MAX_RANGE_M, MIN_RANGE_M
    config.data.deskew = deskew
    config.mapping.voxel_size = voxel_m
    config.registration.max_num_threads = 1
    odometry = KissICP(config)

    def register(points: Array, times: Array, turn: Array | None) -> Array:
        if turn is not None:
            odometry.last_delta = odometry.last_delta.copy()
            odometry.last_delta[:3, :3] = turn
        odometry.register_frame(points, times)
        return np.array(odometry.last_pose)

    return register


def genz_icp(*, deskew: bool, voxel_m: float = VOXEL_M) -> Register:
    """GenZ-ICP, which weighs planes and points by how planar the scan is, on one thread.

    Raises:
        ImportError: If it is not installed; it is no dependency of recon4.
    """
    from genz_icp.config import GenZConfig
    from genz_icp.genz_icp import GenZICP

    config = GenZConfig()
    config.data.max_range, config.data.min_range = MAX_RANGE_M, MIN_RANGE_M
    config.data.deskew = deskew
    config.mapping.voxel_size = voxel_m
    config.registration.max_num_threads = 1
    odometry = GenZICP(config)

    def register(points: Array, times: Array, turn: Array | None) -> Array:
        odometry.register_frame(points, times if deskew else [])
        return np.array(odometry.last_pose)

    return register


def vgicp(*, voxel_m: float = 0.5, downsample_m: float = 0.25) -> Register:
    """small_gicp's VGICP against a Gaussian voxel map of the walk, on one thread."""
    import small_gicp

    target = small_gicp.GaussianVoxelMap(voxel_m)
    target.set_lru(horizon=100, clear_cycle=10)
    state = {"pose": np.eye(4), "delta": np.eye(4)}

    def register(points: Array, times: Array, turn: Array | None) -> Array:
        source, _ = small_gicp.preprocess_points(points, downsample_m, num_threads=1)
        if target.size() == 0:
            target.insert(source, np.eye(4))
            return state["pose"]
        delta = state["delta"].copy()
        if turn is not None:
            delta[:3, :3] = turn
        found = small_gicp.align(
            target, source, state["pose"] @ delta, max_correspondence_distance=1.0, num_threads=1
        )
        pose = found.T_target_source
        state["delta"] = np.linalg.inv(state["pose"]) @ pose
        state["pose"] = pose
        target.insert(source, pose)
        return pose

    return register


def run(
    name: str,
    register: Register,
    frames: Iterable[Multiframe],
    rig: Rig,
    *,
    imu: ImuSamples | None = None,
) -> PeerRun:
    """Feed a recording to a peer.

    Args:
        name: For the table.
        register: `kiss_icp` or `vgicp`.
        frames: The multiframes.
        rig: Mountings; sensors switched off are left out.
        imu: Given: frames are deskewed to their middle and predicted by its gyroscope.
    """
    turn_at = None if imu is None else gyro_rotation(imu, rig)
    t_ns, poses, register_s, deskew_s = [], [], [], []
    before: Array | None = None
    for frame in frames:
        start = time.perf_counter()
        points, times = body_points(frame, rig)
        turn = None
        if turn_at is not None:
            points, R_mid = deskewed(frame, points, times, turn_at)
            turn = None if before is None else before.T @ R_mid
            before = R_mid
        ready = time.perf_counter()
        poses.append(register(points, times, turn))
        register_s.append(time.perf_counter() - ready)
        deskew_s.append(ready - start)
        t_ns.append(frame.t_mid_ns)
    trajectory = Trajectory(np.array(t_ns, dtype=np.int64), SE3.from_matrix(np.stack(poses)))
    return PeerRun(name, trajectory, np.array(register_s), np.array(deskew_s))


def body_points(frame: Multiframe, rig: Rig) -> tuple[Array, Array]:
    """Points of the sensors in use in the body [m], (N, 3), and their times 0..1, (N,)."""
    points, times = [], []
    for row, sensor in enumerate(rig.sensors):
        part = frame.of_sensor(row)
        if sensor.enabled and len(part):
            points.append(sensor.T_body_sensor @ part.xyz.astype(np.float64))
            times.append(np.clip(part.dt_ns / frame.duration_ns, 0.0, 1.0))
    p, s = np.concatenate(points), np.concatenate(times)
    distance = np.linalg.norm(p, axis=1)
    near = (distance > MIN_RANGE_M) & (distance < MAX_RANGE_M)
    return p[near], s[near]


def gyro_rotation(imu: ImuSamples, rig: Rig, *, rest_s: float = 1.0) -> Trajectory:
    """Rotation of the body by the gyroscope alone; bias: the mean of a start at rest."""
    gyro = imu.gyro_rad_s @ rig.T_body_imu.R.T
    start = gyro[imu.t_ns < imu.t_ns[0] + rest_s * 1e9]
    still = np.linalg.norm(start - start.mean(axis=0), axis=1).mean() < 0.02
    gyro = gyro - (start.mean(axis=0) if still else 0.0)
    steps = so3_exp(0.5 * (gyro[1:] + gyro[:-1]) * (np.diff(imu.t_ns) / 1e9)[:, None])
    R = np.empty((len(gyro), 3, 3))
    R[0] = np.eye(3)
    for k, step in enumerate(steps):
        R[k + 1] = R[k] @ step
    return Trajectory(imu.t_ns, SE3(R, np.zeros((len(R), 3))))


def deskewed(
    frame: Multiframe, points: Array, times: Array, rotation: Trajectory
) -> tuple[Array, Array]:
    """Points turned into the body at the middle of the frame, and its rotation there."""
    knots = np.arange(_KNOTS + 1, dtype=np.int64) * frame.duration_ns // _KNOTS + frame.t_ns
    first, last = int(rotation.t_ns[0]), int(rotation.t_ns[-1])
    R = rotation.at(np.clip(knots, first, last)).R
    R_mid = rotation.at(np.array([np.clip(frame.t_mid_ns, first, last)])).R[0]
    row = np.minimum(np.round(times * _KNOTS).astype(np.int64), _KNOTS)
    turns = np.einsum("ji,njk->nik", R_mid, R)
    return np.einsum("nij,nj->ni", turns[row], points), R_mid


def table(runs: Iterable[PeerRun], truth: Trajectory) -> str:
    """Error and time of each run."""
    rows = []
    for found in runs:
        error = absolute_error(pair_poses(found.trajectory, truth)).position_m
        p50, mean = np.median(found.register_s), found.register_s.mean()
        cells = (100 * error.rmse, 100 * error.maximum, 1e3 * p50, 1e3 * mean)
        deskew_ms = 1e3 * found.deskew_s.mean()
        rows.append((found.name, *(number(c, 1) for c in cells), number(deskew_ms, 1)))
    header = ("peer", "ATE RMSE cm", "max cm", "ms p50", "ms mean", "deskew ms")
    return text_table(header, rows)


def main() -> None:
    """Run all peers on a frame store and print the table."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    frames, truth = FrameStore.open(Path(sys.argv[1])), read_tum(Path(sys.argv[2]))
    runs = [
        run("KISS-ICP 0.25 m", kiss_icp(deskew=True), frames, frames.rig),
        run("VGICP", vgicp(), frames, frames.rig),
    ]
    if frames.imu is not None:
        runs += [
            run("KISS-ICP + gyro", kiss_icp(deskew=False), frames, frames.rig, imu=frames.imu),
            run("VGICP + gyro", vgicp(), frames, frames.rig, imu=frames.imu),
        ]
    print(table(runs, truth))


if __name__ == "__main__":
    main()
