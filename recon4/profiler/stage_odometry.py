"""The stage ``odometry`` of a rig with a profiler: 2-D SLAM and IMU give the first trajectory."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3
from recon4.model.events import PosesAdded, TrackingLost, Warned, positions_of
from recon4.model.figures import OdometryFigures
from recon4.model.trajectory import Times, Trajectory
from recon4.profiler.fusion import fuse
from recon4.profiler.imu_chain import Drive, linearize, make_drive
from recon4.profiler.planar import PlanarMap, map_in_plane
from recon4.progress import Progress
from recon4.settings import Settings
from recon4.store.arrays import save_trajectory
from recon4.store.frames import FrameStore
from recon4.store.line_store import load_laser_scans

_FIRST_KNOT_S = 0.05
"""The first trajectory needs no finer knots: the IMU determines what lies between."""
_BRIDGED_NS = 2_000_000_000
"""The IMU bridges a silent 2-D laser for this time [ns] …"""
_BRIDGED_WITHOUT_NS = 500_000_000
"""… and constant velocity for this time [ns]."""
_POSES_AT_ONCE = 200


def run_line_odometry(
    frames: FrameStore, out: Path, *, settings: Settings, progress: Progress
) -> OdometryFigures:
    """Estimate the first trajectory of a recording with line scans.

    Args:
        frames: The multiframes, with scans of the 2-D laser beside them.
        out: Receives ``trajectory.npz`` (``T_odom_body``, dense) and ``steps.npz`` (a row a
            multiframe).
        settings: Uses odometry, lines, and the groups of 2-D SLAM.
        progress: Counts scans; what is missing is an event.
    """
    span_ns = span_of(frames)
    drive = make_drive(
        frames.imu, frames.rig, span_ns, knot_s=_FIRST_KNOT_S, settings=settings.odometry
    )
    scans = load_laser_scans(frames.folder)
    planar = map_in_plane(
        scans,
        frames.rig,
        drive,
        settings=settings,
        progress=progress,
    )
    chain = fuse(drive, planar.poses if planar else None)
    trajectory = linearize(chain).trajectory()
    save_trajectory(out / "trajectory.npz", trajectory)
    lost = _lost(frames.t_mid_ns, planar, drive)
    _save_steps(out / "steps.npz", frames, trajectory, planar=planar, lost=lost)
    warnings = remarks(drive, planar, lost, frames=frames)
    for text in warnings:
        progress.event(Warned(text=text))
    _report(trajectory, frames, lost, progress=progress)
    return OdometryFigures(
        multiframes=len(frames),
        lost=int(lost.sum()),
        imu=drive.has_imu,
        warnings=warnings,
    )


def span_of(frames: FrameStore) -> tuple[int, int]:
    """Start of the first and end of the last multiframe [ns]."""
    index = frames.index
    return int(index["t_ns"][0]), int(index["t_ns"][-1] + index["duration_ns"][-1])


def remarks(
    drive: Drive, planar: PlanarMap | None, lost: NDArray[np.bool_], *, frames: FrameStore
) -> tuple[str, ...]:
    """What the first trajectory lacks, in words."""
    found = []
    if not drive.has_imu:
        missing = "no IMU" if frames.imu is None else "the IMU's samples do not cover the walk"
        found.append(f"{missing}: steps and tilts between two scans of the 2-D laser are not known")
    if planar is None:
        found.append(
            "no 2-D laser: the first trajectory is from the IMU alone and drifts by meters"
        )
        return tuple(found)
    if planar.mirrored:
        found.append(
            "the 2-D laser turns against the gyroscope: its scans were turned over; it is mounted "
            "upside down, or its angles have the wrong sign"
        )
    if lost.any():
        seconds = float(lost.sum() * frames.index["duration_ns"][0]) * 1e-9
        found.append(f"2-D tracking is missing for {seconds:.1f} s: only the IMU bridges that time")
    steps = planar.found.steps
    blind = (steps.degeneracy < 0.02) & ~steps.lost
    if blind.mean() > 0.02:
        found.append(
            f"in {100.0 * blind.mean():.0f} % of the 2-D scans a direction is unobservable: a long "
            "homogeneous corridor, or open space beyond the range of the 2-D laser"
        )
    return tuple(found)


def _lost(t_ns: Times, planar: PlanarMap | None, drive: Drive) -> NDArray[np.bool_]:
    """Multiframes farther in time from a tracked 2-D scan than what bridges it can."""
    if planar is None:
        return np.zeros(len(t_ns), np.bool_)
    known = planar.poses.t_ns
    after = np.clip(np.searchsorted(known, t_ns), 1, len(known) - 1)
    away_ns = np.minimum(np.abs(t_ns - known[after - 1]), np.abs(known[after] - t_ns))
    bridged_ns = _BRIDGED_NS if drive.has_imu else _BRIDGED_WITHOUT_NS
    return np.asarray(away_ns > bridged_ns, dtype=np.bool_)


def _save_steps(
    path: Path,
    frames: FrameStore,
    trajectory: Trajectory,
    *,
    planar: PlanarMap | None,
    lost: NDArray[np.bool_],
) -> None:
    """One row a multiframe, with the columns of the odometry of LiDARs."""
    t_ns, count = frames.t_mid_ns, len(frames)
    T = trajectory.at(t_ns)
    nearest = np.zeros(count, np.intp)
    ratio, degeneracy = np.zeros(count), np.zeros(count)
    weak, weak_sd_m = np.full((count, 3), np.nan), np.full(count, np.nan)
    if planar is not None:
        steps = planar.found.steps
        nearest = np.clip(np.searchsorted(steps.t_ns, t_ns), 0, len(steps.t_ns) - 1)
        ratio, degeneracy = steps.match_ratio[nearest], steps.degeneracy[nearest] * 2.0 / 3.0
        weak[:, :2], weak[:, 2] = steps.weak_direction[nearest], 0.0
        weak_sd_m = steps.weak_sd_m[nearest]
    motion = np.diag(np.repeat([0.003, 0.005], 3) ** 2)
    np.savez(
        path,
        frame_id=frames.index["frame_id"],
        t_mid_ns=t_ns,
        quat_xyzw=T.quat_xyzw(),
        t_m=T.t,
        error_m=np.full(count, np.nan),
        match_ratio=ratio,
        rounds=np.ones(count, np.int64),
        converged=~lost,
        degeneracy=degeneracy,
        prediction_offset_m=np.zeros(count),
        lost=lost,
        motion_cov=np.tile(motion, (count, 1, 1)),
        weak_direction=weak,
        stationary=np.zeros(count, np.bool_),
        weak_sd_m=weak_sd_m,
    )


def _report(
    trajectory: Trajectory, frames: FrameStore, lost: NDArray[np.bool_], *, progress: Progress
) -> None:
    """Poses for a display, and where tracking began to be lost."""
    t_ns = frames.t_mid_ns
    for row in np.flatnonzero(np.diff(lost.astype(np.int8), prepend=0) > 0):
        progress.event(TrackingLost(frame_id=int(row), t_ns=int(t_ns[row])))
    rows = np.arange(0, len(t_ns), 5)
    for part in np.array_split(rows, max(1, len(rows) // _POSES_AT_ONCE)):
        T: SE3 = trajectory.at(t_ns[part])
        x = np.round(T.quat_xyzw(), 5).tolist()
        progress.event(
            PosesAdded(
                t_ns=tuple(t_ns[part].tolist()),
                t_m=positions_of(T.t),
                quat_xyzw=tuple((q[0], q[1], q[2], q[3]) for q in x),
            )
        )
