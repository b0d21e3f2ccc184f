"""2-D SLAM in memory: scans in, trajectory, verified graph and grid out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se2 import from_se3, to_se3, transform
from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.pose_graph import PoseGraph
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.verification import verify
from recon4.progress import Progress, Silent, track
from recon4.settings import Settings
from recon4.settings.reads import Map2dReads, Odometry2dReads, Slam2dReads, part_of
from recon4.settings.tuning import tuned
from recon4.slam2d.correction import corrected_poses
from recon4.slam2d.covariance import node_covariances
from recon4.slam2d.hector_odometry import run_hector
from recon4.slam2d.keyframes import Keyframes, make_keyframes
from recon4.slam2d.loops import close_loops
from recon4.slam2d.occupancy import OccupancyGrid, fitting_cell_m
from recon4.slam2d.odometry import run_odometry_2d
from recon4.slam2d.scan_points import leveling, scan_points
from recon4.slam2d.steps import Steps2d
from recon4.slam2d.tuning import Grid2dTuning, HectorTuning, Loop2dTuning, Slam2dTuning
from recon4.slam2d.tuning_graph import GRID_STEPS


@dataclass(frozen=True, slots=True, eq=False)
class Slam2dResult:
    """A finished 2-D map."""

    trajectory: Trajectory
    """``T_map_laser`` of each scan: height, roll and pitch are zero."""
    poses: Array
    """The same as x [m], y [m], yaw [rad], (N, 3)."""
    covariance: Array
    """For yaw, x, y in the axes of the laser, relative to the first scan, (N, 3, 3)."""
    graph: PoseGraph
    """Keyframes and all edges with verdicts; ``frame_ids`` are rows of scans."""
    steps: Steps2d
    """What odometry found."""
    grid: OccupancyGrid


def slam2d(
    scans: LaserScans,
    *,
    attitude: Trajectory | None = None,
    settings: Slam2dReads | None = None,
    progress: Progress | None = None,
) -> Slam2dResult:
    """Map the scans of a 2-D laser.

    Args:
        scans: At least one; their odometry is used if there is any.
        attitude: Attitude of the laser (``R_world_laser``, as of an IMU) around the times of all
            scans; positions are ignored. Roll and pitch level the scans, the yaw predicts turns.
        settings: None = the defaults.
        progress: Counts scans and pairs.

    Raises:
        OutOfRange: If the attitude does not cover the scans.
        GraphError: If the graph cannot be solved.
        Cancelled: If the caller requested to stop.
    """
    settings, watcher = settings or part_of(Settings(), Slam2dReads), progress or Silent()
    steps = run_steps(scans, attitude=attitude, settings=settings, progress=watcher)
    keyframes = make_keyframes(
        scans, steps, attitude=attitude, settings=tuned(Slam2dTuning, settings.slam2d)
    )
    searched = close_loops(
        keyframes,
        settings=tuned(Slam2dTuning, settings.slam2d),
        loops=tuned(Loop2dTuning, settings.loops2d),
        progress=watcher,
    )
    graph = verify(searched, settings=settings.verification, progress=watcher).graph
    poses = map_poses(steps, keyframes, graph)
    return Slam2dResult(
        trajectory=Trajectory(scans.t_ns, to_se3(poses)),
        poses=poses,
        covariance=scan_covariances(keyframes, graph, len(scans)),
        graph=graph,
        steps=steps,
        grid=make_grid(scans, poses, attitude=attitude, settings=settings, progress=watcher),
    )


def run_steps(
    scans: LaserScans, *, attitude: Trajectory | None, settings: Odometry2dReads, progress: Progress
) -> Steps2d:
    """Odometry with the method of the settings."""
    if settings.slam2d.method == "hector":
        return run_hector(
            scans,
            attitude=attitude,
            settings=tuned(Slam2dTuning, settings.slam2d),
            hector=HectorTuning(),
            progress=progress,
        )
    return run_odometry_2d(
        scans, attitude=attitude, settings=tuned(Slam2dTuning, settings.slam2d), progress=progress
    )


def map_poses(steps: Steps2d, keyframes: Keyframes, graph: PoseGraph) -> Array:
    """Poses of all scans by the solved graph, (N, 3)."""
    return corrected_poses(steps.pose, keyframes, from_se3(graph.T_map_body))


def scan_covariances(keyframes: Keyframes, graph: PoseGraph, scans: int) -> Array:
    """Covariance of each scan: that of the keyframe before it, (N, 3, 3)."""
    before = np.searchsorted(keyframes.rows, np.arange(scans), side="right") - 1
    return np.asarray(node_covariances(graph)[np.clip(before, 0, None)])


def make_grid(
    scans: LaserScans,
    poses: Array,
    *,
    attitude: Trajectory | None,
    settings: Map2dReads,
    progress: Progress,
) -> OccupancyGrid:
    """The occupancy grid of all scans at their final poses.

    Args:
        scans: All scans.
        poses: ``T_map_laser`` as x [m], y [m], yaw [rad], (N, 3).
        attitude: As for `slam2d`.
        settings: Groups ``slam2d`` (limits of range) and ``grid2d``.
        progress: Counts scans.
    """
    chosen = tuned(Grid2dTuning, settings.grid2d)
    level = None
    if attitude is not None:
        level = leveling(attitude.at(scans.t_ns, slack_ns=1_000_000_000))

    def placed(k: int) -> Array:
        R = None if level is None else level[k]
        seen = scan_points(scans, k, settings=tuned(Slam2dTuning, settings.slam2d), R_level_laser=R)
        return transform(poses[k], seen.points)

    # Made at once: growing with the walk would copy a large grid again and again.
    corners = np.concatenate([_corners(placed(k), poses[k]) for k in range(len(scans))])
    low, high = corners.min(axis=0), corners.max(axis=0)
    cell_m = fitting_cell_m(low, high, chosen.cell_m)
    grid = OccupancyGrid(cell_m, chosen.p_free, chosen.p_occupied)
    grid.cover(low, high)
    last = np.full(3, np.inf)
    for k in track(range(len(scans)), progress, what="Grid", unit="scans"):
        moved = poses[k] - last
        near = float(np.hypot(moved[0], moved[1])) < GRID_STEPS.grid_step_m
        if near and abs(float(moved[2])) < GRID_STEPS.grid_step_rad:
            continue
        grid.add_scan(placed(k), poses[k, :2])
        last = poses[k]
    return grid


def _corners(p_map: Array, pose: Array) -> Array:
    """Smallest and largest x and y of the returns of a scan and its laser [m], (2, 2)."""
    both = np.concatenate([pose[None, :2], p_map])
    return np.stack([both.min(axis=0), both.max(axis=0)])
