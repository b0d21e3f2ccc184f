"""The stage ``odometry`` of a rig with a profiler: 2-D SLAM and IMU give the first trajectory."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3
from recon4.model.events import PosesAdded, TrackingLost, Warned, positions_of
from recon4.model.figures import OdometryFigures
from recon4.model.laser_scans import LaserScans
from recon4.model.trajectory import Times, Trajectory
from recon4.profiler.clock_audit import SAID_S, profiler_ahead_s, some_points
from recon4.profiler.fusion import fuse
from recon4.profiler.imu_chain import Drive, linearize, make_drive
from recon4.profiler.mount_audit import mount_change
from recon4.profiler.planar import PlanarMap, map_in_plane
from recon4.profiler.samples import TimedPoints
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
_SILENT_S = 1.0


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
    has_laser = frames.rig.row_of("laser2d") is not None
    scans = load_laser_scans(frames.folder) if has_laser else None
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
    warnings = (
        *laser_remarks(scans, span_ns, is_used=planar is not None),
        *remarks(drive, planar, lost, frames=frames),
        *_profiler_remarks(frames, planar, trajectory, min_range_m=settings.lines.min_range_m),
    )
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


def laser_remarks(
    scans: LaserScans | None, span_ns: tuple[int, int], *, is_used: bool
) -> tuple[str, ...]:
    """What is missing of the scans of the 2-D laser, in words.

    Args:
        scans: All of them.
        span_ns: First and last time of the lines [ns].
        is_used: Whether there is a planar map.
    """
    alone = "the first trajectory is from the IMU alone and drifts by meters"
    if scans is None:
        return (f"no 2-D laser: {alone}",)
    if not is_used:
        first, last = (1e-9 * float(scans.t_ns[k] - span_ns[0]) for k in (0, -1))
        return (
            f"the scans of the 2-D laser cover {first:.1f} … {last:.1f} s of a walk of "
            f"{1e-9 * (span_ns[1] - span_ns[0]):.1f} s: are the clocks the same? Without them "
            f"{alone}",
        )
    inside = scans.t_ns[(scans.t_ns >= span_ns[0]) & (scans.t_ns <= span_ns[1])]
    times = np.concatenate([[span_ns[0]], inside, [span_ns[1]]])
    seconds = 1e-9 * np.diff(times)
    silent = np.flatnonzero(seconds > _SILENT_S)
    if not len(silent):
        return ()
    since_s = 1e-9 * float(times[silent[0]] - span_ns[0])
    return (
        f"the 2-D laser is silent for {seconds[silent].sum():.1f} s, first {since_s:.1f} s after "
        "the start",
    )


def remarks(
    drive: Drive, planar: PlanarMap | None, lost: NDArray[np.bool_], *, frames: FrameStore
) -> tuple[str, ...]:
    """What the first trajectory lacks, in words."""
    found = []
    if not drive.has_imu:
        missing = "no IMU" if frames.imu is None else "the IMU's samples do not cover the walk"
        found.append(f"{missing}: steps and tilts between two scans of the 2-D laser are not known")
    if planar is None:
        return tuple(found)
    if planar.mirrored:
        found.append(
            "the 2-D laser turns against the gyroscope: its scans were turned over; it is mounted "
            "upside down, or its angles have the wrong sign"
        )
    if planar.lag is not None and planar.lag.is_wrong:
        ahead_s = planar.lag.ahead_s
        found.append(
            f"the clock of the IMU is {1e3 * abs(ahead_s):.0f} ms "
            f"{'ahead of' if ahead_s > 0 else 'behind'} that of the 2-D laser: in the rig file add "
            f"{-ahead_s:+.3f} to time_offset_s of the IMU, or {ahead_s:+.3f} to that of the 2-D "
            "laser, whichever does not run with the profiler"
        )
    if lost.any():
        seconds = float(lost.sum() * frames.index["duration_ns"][0]) * 1e-9
        found.append(f"2-D tracking is missing for {seconds:.1f} s: only the IMU bridges that time")
    return tuple(found)


def _profiler_remarks(
    frames: FrameStore, planar: PlanarMap | None, trajectory: Trajectory, *, min_range_m: float
) -> tuple[str, ...]:
    """Whether the profiler has another clock or mount than the rig file says.

    It is compared with IMU and 2-D laser, if the clocks of these two agree.
    """
    if planar is None or planar.lag is None or planar.lag.is_wrong:
        return ()
    points = some_points(frames, min_range_m=min_range_m)
    ahead_s = profiler_ahead_s(points, trajectory)
    found = []
    if abs(ahead_s) >= SAID_S:
        way = "ahead of" if ahead_s > 0 else "behind"
        found.append(
            f"the clock of the profiler is {1e3 * abs(ahead_s):.0f} ms {way} those of the IMU and "
            f"the 2-D laser: in the rig file add {-ahead_s:+.3f} to its time_offset_s"
        )
        points = TimedPoints(points.t_ns - round(1e9 * ahead_s), points.p_body)
    sensor = frames.rig.sensors[frames.rig.row_of("profiler") or 0]
    change = mount_change(points, sensor.T_body_sensor.t, trajectory)
    if change is not None and change.is_wrong:
        found.append(
            "the map is sharper with the profiler mounted otherwise than the rig file says: "
            f"{change.describe()} of the body, against the 2-D laser; calibrate with the command "
            "recon4 calibrate --method entropy"
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
