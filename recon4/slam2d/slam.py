"""2-D SLAM in memory: scans in, trajectory, verified graph and grid out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from recon4.geometry.se2 import between, compose, from_se3, to_se3, transform, wrap
from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.pose_graph import PoseGraph, Rows
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.inverses import inverted
from recon4.pose_graph.verification import verify
from recon4.progress import Progress, Silent, track
from recon4.settings import Settings
from recon4.settings.reads import Map2dReads, Odometry2dReads, Slam2dReads, part_of
from recon4.settings.tuning import tuned
from recon4.slam2d.edges import plane_information
from recon4.slam2d.hector_odometry import run_hector
from recon4.slam2d.keyframes import Keyframes, make_keyframes
from recon4.slam2d.loops import close_loops
from recon4.slam2d.occupancy import OccupancyGrid, fitting_cell_m
from recon4.slam2d.odometry import run_odometry_2d
from recon4.slam2d.scan_points import leveling, scan_points
from recon4.slam2d.steps import Steps2d
from recon4.slam2d.tuning import Grid2dTuning, HectorTuning, Loop2dTuning, Slam2dTuning
from recon4.slam2d.tuning_graph import COVARIANCE_2D, GRID_STEPS


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


def corrected_poses(pose: Array, keyframes: Keyframes, T_map_key: Array) -> Array:
    """Poses of all scans in the map: the motions between keyframes bend to fit the solved ones.

    Each scan is placed from the keyframe before and from the one after it; in between the two
    results are blended by row.

    Args:
        pose: Poses of all scans by odometry, (N, 3).
        keyframes: Nodes of the graph.
        T_map_key: Their solved poses, (K, 3).
    """
    rows = np.arange(len(pose))
    before = np.clip(np.searchsorted(keyframes.rows, rows, side="right") - 1, 0, None)
    after = np.minimum(before + 1, len(keyframes) - 1)
    first = compose(T_map_key[before], between(keyframes.pose[before], pose))
    second = compose(T_map_key[after], between(keyframes.pose[after], pose))
    span = keyframes.rows[after] - keyframes.rows[before]
    fraction = np.clip((rows - keyframes.rows[before]) / np.maximum(span, 1), 0.0, 1.0)[:, None]
    turned = wrap(second[:, 2] - first[:, 2])
    blended = first + fraction * (second - first)
    blended[:, 2] = wrap(first[:, 2] + fraction[:, 0] * turned)
    return blended


def node_covariances(graph: PoseGraph) -> Array:
    """Marginal covariances for yaw, x, y in the axes of each node, (K, 3, 3).

    The sparse inverse is computed only at the nonzero entries of the factor (Takahashi 1973).
    """
    nodes, of = len(graph), graph.relations
    used = np.flatnonzero(of.in_graph)
    i, j = of.i[used], of.j[used]
    W = plane_information(of.information[used])
    pose = from_se3(graph.T_map_body)
    A = -_adjoint(between(pose[j], pose[i]))
    left = np.swapaxes(A, 1, 2) @ W
    every, first = np.arange(nodes), np.zeros(1, np.intp)
    blocks = [
        (i, i, left @ A),
        (i, j, left),
        (j, i, W @ A),
        (j, j, W),
        (
            every,
            every,
            np.full((nodes, 3, 3), COVARIANCE_2D.nothing * float(np.abs(W).max(initial=1.0))),
        ),
        (first, first, COVARIANCE_2D.gauge * np.eye(3)[None]),
    ]
    return inverted(_assembled(blocks, nodes), axes=3).blocks(every, every)


def _assembled(blocks: Sequence[tuple[Rows, Rows, Array]], nodes: int) -> csc_array:
    row, column = np.meshgrid(np.arange(3), np.arange(3), indexing="ij")
    at_row = np.concatenate([(3 * a[:, None, None] + row).ravel() for a, _, _ in blocks])
    at_column = np.concatenate([(3 * b[:, None, None] + column).ravel() for _, b, _ in blocks])
    values = np.concatenate([np.asarray(block).ravel() for _, _, block in blocks])
    return csc_array((values, (at_row, at_column)), shape=(3 * nodes, 3 * nodes))


def _adjoint(T_a_b: Array) -> Array:
    """Adjoint matrices for yaw, x, y that map twists of ``b`` to ``a``, (..., 3, 3)."""
    c, s = np.cos(T_a_b[..., 2]), np.sin(T_a_b[..., 2])
    out = np.zeros((*T_a_b.shape[:-1], 3, 3))
    out[..., 0, 0] = 1.0
    out[..., 1, 0], out[..., 2, 0] = T_a_b[..., 1], -T_a_b[..., 0]
    out[..., 1, 1], out[..., 1, 2] = c, -s
    out[..., 2, 1], out[..., 2, 2] = s, c
    return out
