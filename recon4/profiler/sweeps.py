"""Sweeps of the head as scans: unwound points around a node in the middle of each sweep."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3
from recon4.model.line_scans import LineScans
from recon4.model.trajectory import Times, Trajectory
from recon4.profiler.samples import line_points
from recon4.profiler.tuning import LineTuning
from recon4.progress import Progress
from recon4.registration.scan_registration import thinned
from recon4.store.frames import FrameStore


@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """One sweep of the head as a rigid scan."""

    points: NDArray[np.float32]
    """Unwound and thinned, in the body at the node's time [m], (N, 3)."""
    lines: int
    """Number of its line scans."""


@dataclass(frozen=True, slots=True, eq=False)
class Sweeps:
    """All sweeps of a walk."""

    t_ns: Times
    """Time of each node: the middle of its sweep [ns], (T,)."""
    start_ns: Times
    """First time of each sweep, and the end of the last one [ns], (T + 1,)."""
    frame_rows: NDArray[np.int64]
    """Multiframe of each node, (T,)."""
    sweeps: tuple[Sweep, ...]

    def __len__(self) -> int:
        return len(self.sweeps)


@dataclass(frozen=True, slots=True, eq=False)
class SweepNodes:
    """When the sweeps of a walk begin, and their nodes."""

    t_ns: Times
    """Time of each node: the middle of its sweep [ns], (T,)."""
    start_ns: Times
    """First time of each sweep, and the end of the last one [ns], (T + 1,)."""
    frame_rows: NDArray[np.int64]
    """Multiframe of each node, (T,)."""

    def multiframes(self, frames: FrameStore, sweep: int) -> range:
        """Multiframes with points of a sweep."""
        start_ns, end_ns = self.start_ns[sweep : sweep + 2]
        begins = frames.index["t_ns"]
        ends = begins + frames.index["duration_ns"]
        first, last = np.searchsorted(ends, start_ns), np.searchsorted(begins, end_ns)
        return range(int(first), int(last))


def find_sweeps(frames: FrameStore, lines: LineScans) -> SweepNodes:
    """Sweeps of the head, each with the multiframe in its middle as node."""
    ends = lines.sweeps()
    start_ns = np.append(lines.t_ns[ends[:-1]], lines.t_ns[-1] + 1)
    t_mid_ns = frames.t_mid_ns
    middle = start_ns[:-1] + np.diff(start_ns) // 2
    rows = np.clip(np.searchsorted(t_mid_ns, middle), 0, len(t_mid_ns) - 1).astype(np.int64)
    if len(np.unique(rows)) < len(rows):  # sweeps shorter than a multiframe
        rows, first = np.unique(rows, return_index=True)
        start_ns = np.append(start_ns[first], start_ns[-1])
    # Points before the first line scan and after the last one belong to these.
    last = frames.index[-1]
    start_ns[0] = min(start_ns[0], frames.index["t_ns"][0])
    start_ns[-1] = max(start_ns[-1], last["t_ns"] + last["duration_ns"] + 1)
    return SweepNodes(t_mid_ns[rows], start_ns, rows)


def unwind_sweeps(
    frames: FrameStore,
    lines: LineScans,
    trajectory: Trajectory,
    *,
    settings: LineTuning,
    progress: Progress,
) -> Sweeps:
    """Place every point by the pose of its own time, sweep by sweep (L §4.2, A12 L-2).

    Args:
        frames: The points.
        lines: The line scans, with the angles of the head.
        trajectory: ``T_odom_body``.
        settings: Thinning and shortest range.
        progress: Counts multiframes.
    """
    nodes = find_sweeps(frames, lines)
    counts = np.diff(np.searchsorted(lines.t_ns, nodes.start_ns))
    progress.start("unwind", len(nodes.t_ns), "sweep")
    sweeps = []
    for k in range(len(nodes.t_ns)):
        points = unwind_sweep(frames, nodes, k, trajectory=trajectory, settings=settings)
        sweeps.append(Sweep(points, int(counts[k])))
        progress.advance()
    return Sweeps(nodes.t_ns, nodes.start_ns, nodes.frame_rows, tuple(sweeps))


def unwind_sweep(
    frames: FrameStore,
    nodes: SweepNodes,
    sweep: int,
    *,
    trajectory: Trajectory,
    settings: LineTuning,
) -> NDArray[np.float32]:
    """Points of one sweep in the body at its node [m], thinned, (N, 3)."""
    start_ns, end_ns = nodes.start_ns[sweep : sweep + 2]
    parts = [np.empty((0, 3))]
    for row in nodes.multiframes(frames, sweep):
        points = line_points(
            frames, row, every=settings.turn_every, min_range_m=settings.min_range_m
        )
        inside = (points.t_ns >= start_ns) & (points.t_ns < end_ns)
        parts.append(points.placed(trajectory)[inside])
    T_odom_node = trajectory.at(nodes.t_ns[sweep : sweep + 1])[0]
    p_node = T_odom_node.inverse() @ np.concatenate(parts)
    return thinned(p_node, settings.turn_voxel_m).astype(np.float32)


def relative(T_odom_node: SE3, i: int, j: int) -> SE3:
    """Pose of node ``j`` in node ``i``."""
    return T_odom_node[i].inverse() @ T_odom_node[j]
