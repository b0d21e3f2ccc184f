"""Turns of the head as scans: unwound points around a node in the middle of each turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.model.line_scans import LineScans
from recon4.model.trajectory import Times, Trajectory
from recon4.profiler.samples import line_points
from recon4.progress import Progress
from recon4.registration.scans import thinned
from recon4.settings import LineSettings
from recon4.store.frames import FrameStore


@dataclass(frozen=True, slots=True, eq=False)
class Turn:
    """One turn of the head as a rigid scan."""

    points: NDArray[np.float32]
    """Unwound and thinned, in the body at the node's time [m], (N, 3)."""
    lines: int
    """Number of its line scans."""


@dataclass(frozen=True, slots=True, eq=False)
class Turns:
    """All turns of a walk."""

    t_ns: Times
    """Time of each node: the middle of its turn [ns], (T,)."""
    start_ns: Times
    """First time of each turn, and the end of the last one [ns], (T + 1,)."""
    frame_rows: NDArray[np.int64]
    """Multiframe of each node, (T,)."""
    turns: tuple[Turn, ...]

    def __len__(self) -> int:
        return len(self.turns)


def unwind_turns(
    frames: FrameStore,
    lines: LineScans,
    trajectory: Trajectory,
    *,
    settings: LineSettings,
    progress: Progress,
) -> Turns:
    """Place every point by the pose of its own time, turn by turn (L §4.2, A12 L-2).

    Args:
        frames: The points.
        lines: The line scans, with the angles of the head.
        trajectory: ``T_odom_body``.
        settings: Thinning and shortest range.
        progress: Counts multiframes.
    """
    ends = lines.turns()
    start_ns = np.append(lines.t_ns[ends[:-1]], lines.t_ns[-1] + 1)
    t_mid_ns = frames.t_mid_ns
    middle = start_ns[:-1] + np.diff(start_ns) // 2
    rows = np.clip(np.searchsorted(t_mid_ns, middle), 0, len(t_mid_ns) - 1).astype(np.int64)
    if len(np.unique(rows)) < len(rows):  # turns shorter than a multiframe
        rows, first = np.unique(rows, return_index=True)
        start_ns = np.append(start_ns[first], start_ns[-1])
    node_ns = t_mid_ns[rows]
    T_odom_node = trajectory.at(node_ns)
    clouds: list[list[Array]] = [[] for _ in rows]
    progress.start("unwind", len(frames), "multiframe")
    for row in range(len(frames)):
        points = line_points(
            frames, row, every=settings.turn_every, min_range_m=settings.min_range_m
        )
        p_odom = points.placed(trajectory)
        turn = np.clip(np.searchsorted(start_ns, points.t_ns, side="right") - 1, 0, len(rows) - 1)
        for k in np.unique(turn):
            clouds[k].append(p_odom[turn == k])
        progress.advance()
    counts = np.diff(np.searchsorted(lines.t_ns, start_ns))
    turns = []
    for k, parts in enumerate(clouds):
        p = np.concatenate(parts) if parts else np.empty((0, 3))
        thin = thinned(T_odom_node[k].inverse() @ p, settings.turn_voxel_m)
        clouds[k] = []
        turns.append(Turn(thin.astype(np.float32), int(counts[k])))
    return Turns(node_ns, start_ns, rows, tuple(turns))


def relative(T_odom_node: SE3, i: int, j: int) -> SE3:
    """Pose of node ``j`` in node ``i``."""
    return T_odom_node[i].inverse() @ T_odom_node[j]
