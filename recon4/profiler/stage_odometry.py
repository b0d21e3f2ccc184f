"""The stage ``odometry`` of a rig with a profiler: 2-D SLAM and IMU give the first trajectory."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3
from recon4.model.events import PosesAdded, TrackingLost, positions_of
from recon4.model.laser_scans import LaserScans
from recon4.model.odometry_figures import LineFigures, OdometryFigures
from recon4.model.trajectory import Times, Trajectory
from recon4.profiler.at_rest import AtRest
from recon4.profiler.clock_audit import profiler_ahead_s, some_points
from recon4.profiler.fusion import fuse
from recon4.profiler.imu_chain import Drive, linearize, make_drive
from recon4.profiler.mount_audit import mount_change
from recon4.profiler.planar import PlanarMap, map_in_plane
from recon4.profiler.samples import TimedPoints
from recon4.profiler.tuning import LineTuning
from recon4.profiler.tuning_audits import CLOCK_AUDIT
from recon4.profiler.tuning_solve import FIRST_LINES
from recon4.progress import Progress
from recon4.settings.reads import LineOdometryReads
from recon4.settings.tuning import tuned
from recon4.store.arrays import save_trajectory
from recon4.store.frames import FrameStore
from recon4.store.line_store import load_laser_scans


def run_line_odometry(
    frames: FrameStore, out: Path, *, settings: LineOdometryReads, progress: Progress
) -> OdometryFigures:
    """Estimate the first trajectory of a recording with line scans.

    Args:
        frames: The multiframes, with scans of the 2-D laser beside them.
        out: Receives ``trajectory.npz`` (``T_odom_body``, dense) and ``steps.npz`` (a row a
            multiframe).
        settings: Uses odometry, lines, and the groups of 2-D SLAM.
        progress: Counts scans; tracking that is lost is an event.
    """
    span_ns = span_of(frames)
    drive = make_drive(
        frames.imu, frames.rig, span_ns, knot_s=FIRST_LINES.first_knot_s, settings=settings.odometry
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
    known = _known(frames.t_mid_ns, planar, drive)
    _save_steps(out / "steps.npz", frames, trajectory, planar=planar, known=known)
    ahead_s, change = _profiler_error(
        frames, planar, trajectory, min_range_m=tuned(LineTuning, settings.lines).min_range_m
    )
    lines = replace(
        line_figures(scans, span_ns, is_used=planar is not None),
        imu=_imu_state(drive, frames),
        mirrored=planar is not None and planar.mirrored,
        imu_ahead_s=_imu_ahead_s(planar),
        rest_s=float(known.still.sum() * frames.index["duration_ns"][0]) * 1e-9,
        bridged_s=float(known.lost.sum() * frames.index["duration_ns"][0]) * 1e-9,
        profiler_ahead_s=ahead_s,
        mount_change=change,
    )
    _report(trajectory, frames, known.lost, progress=progress)
    return OdometryFigures(
        multiframes=len(frames),
        lost=int(known.lost.sum()),
        imu=drive.has_imu,
        lines=lines,
    )


def span_of(frames: FrameStore) -> tuple[int, int]:
    """Start of the first and end of the last multiframe [ns]."""
    index = frames.index
    return int(index["t_ns"][0]), int(index["t_ns"][-1] + index["duration_ns"][-1])


def line_figures(
    scans: LaserScans | None, span_ns: tuple[int, int], *, is_used: bool
) -> LineFigures:
    """What is missing of the scans of the 2-D laser.

    Args:
        scans: All of them.
        span_ns: First and last time of the lines [ns].
        is_used: Whether there is a planar map.
    """
    walk_s = 1e-9 * (span_ns[1] - span_ns[0])
    if scans is None:
        return LineFigures(walk_s=walk_s, laser="none")
    first_s, last_s = (1e-9 * float(scans.t_ns[k] - span_ns[0]) for k in (0, -1))
    if not is_used:
        return LineFigures(walk_s=walk_s, laser="at other times", laser_span_s=(first_s, last_s))
    inside = scans.t_ns[(scans.t_ns >= span_ns[0]) & (scans.t_ns <= span_ns[1])]
    times = np.concatenate([[span_ns[0]], inside, [span_ns[1]]])
    seconds = 1e-9 * np.diff(times)
    silent = np.flatnonzero(seconds > FIRST_LINES.silent_s)
    return LineFigures(
        walk_s=walk_s,
        laser="used",
        laser_span_s=(first_s, last_s),
        silent_s=float(seconds[silent].sum()),
        silent_from_s=1e-9 * float(times[silent[0]] - span_ns[0]) if len(silent) else 0.0,
    )


def _imu_state(drive: Drive, frames: FrameStore) -> Literal["used", "none", "uncovered"]:
    if drive.has_imu:
        return "used"
    return "none" if frames.imu is None else "uncovered"


def _imu_ahead_s(planar: PlanarMap | None) -> float | None:
    """How far the clock of the IMU is ahead of that of the 2-D laser [s]; None = it is not."""
    lag = planar.lag if planar is not None else None
    return lag.ahead_s if lag is not None and lag.is_wrong else None


def _profiler_error(
    frames: FrameStore, planar: PlanarMap | None, trajectory: Trajectory, *, min_range_m: float
) -> tuple[float | None, str]:
    """How far the clock of the profiler is ahead [s], and how its mount differs from the rig file.

    It is compared with IMU and 2-D laser, if the clocks of these two agree.
    """
    if planar is None or planar.lag is None or planar.lag.is_wrong:
        return None, ""
    points = some_points(frames, min_range_m=min_range_m)
    ahead_s = profiler_ahead_s(points, trajectory)
    is_ahead = abs(ahead_s) >= CLOCK_AUDIT.said_s
    if is_ahead:
        points = TimedPoints(points.t_ns - round(1e9 * ahead_s), points.p_body)
    sensor = frames.rig.sensors[frames.rig.row_of("profiler") or 0]
    change = mount_change(points, sensor.T_body_sensor.t, trajectory)
    is_moved = change is not None and change.is_wrong
    return ahead_s if is_ahead else None, change.describe() if change and is_moved else ""


@dataclass(frozen=True, slots=True, eq=False)
class _KnownMotion:
    """How the motion of each multiframe is known."""

    lost: NDArray[np.bool_]
    """Farther in time from a tracked 2-D scan than what bridges it can, (N,)."""
    still: NDArray[np.bool_]
    """At rest by the IMU, where no 2-D laser observes the motion, (N,)."""


def _known(t_ns: Times, planar: PlanarMap | None, drive: Drive) -> _KnownMotion:
    """How the motion at the middle of each multiframe is known."""
    none = np.zeros(len(t_ns), np.bool_)
    if planar is None:
        still = AtRest.of(drive).still
        interval = np.searchsorted(drive.knot_ns, t_ns, side="right") - 1
        return _KnownMotion(none, np.asarray(still[np.clip(interval, 0, len(still) - 1)]))
    return _KnownMotion(_lost(t_ns, planar, drive), none)


def _lost(t_ns: Times, planar: PlanarMap, drive: Drive) -> NDArray[np.bool_]:
    """Multiframes farther in time from a tracked 2-D scan than what bridges it can."""
    known = planar.poses.t_ns
    after = np.clip(np.searchsorted(known, t_ns), 1, len(known) - 1)
    away_ns = np.minimum(np.abs(t_ns - known[after - 1]), np.abs(known[after] - t_ns))
    bridged_ns = FIRST_LINES.bridged_ns if drive.has_imu else FIRST_LINES.bridged_without_ns
    return np.asarray(away_ns > bridged_ns, dtype=np.bool_)


def _save_steps(
    path: Path,
    frames: FrameStore,
    trajectory: Trajectory,
    *,
    planar: PlanarMap | None,
    known: _KnownMotion,
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
        converged=~known.lost,
        degeneracy=degeneracy,
        prediction_offset_m=np.zeros(count),
        lost=known.lost,
        motion_cov=np.tile(motion, (count, 1, 1)),
        weak_direction=weak,
        stationary=known.still,
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
    for part in np.array_split(rows, max(1, len(rows) // FIRST_LINES.poses_at_once)):
        T: SE3 = trajectory.at(t_ns[part])
        x = np.round(T.quat_xyzw(), 5).tolist()
        progress.event(
            PosesAdded(
                t_ns=tuple(t_ns[part].tolist()),
                t_m=positions_of(T.t),
                quat_xyzw=tuple((q[0], q[1], q[2], q[3]) for q in x),
            )
        )
