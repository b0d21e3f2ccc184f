"""Scans with poses for 3DTK: one a node of the pose graph, in a folder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.mapping.undistort import place
from recon4.model.multiframe import Multiframe
from recon4.model.trajectory import Trajectory
from recon4.progress import Progress, track
from recon4.recording.formats.three_dtk import (
    POSE_SUFFIX,
    SCAN_SUFFIX,
    write_pose,
    write_scan,
)
from recon4.store.frames import FrameStore


@dataclass(frozen=True, slots=True)
class ScanRows:
    """Multiframes that belong to one scan."""

    t_ns: int
    """Time of its pose [ns]."""
    rows: range
    span_ns: tuple[int, int]
    """Points from the first to before the second time belong to it [ns]."""


def export_scans(
    frames: FrameStore,
    trajectory: Trajectory,
    scans: Sequence[ScanRows],
    *,
    folder: Path,
    progress: Progress,
) -> int:
    """Write undistorted scans: ``scan000.3d``, ``scan000.pose`` and ``scan000.frames`` each.

    Args:
        frames: The points.
        trajectory: ``T_map_body``.
        scans: Which multiframes make a scan, and when.
        folder: An empty folder.
        progress: Counts scans.

    Returns:
        Points written.
    """
    points = 0
    for number, scan in enumerate(track(scans, progress, what="export", unit="scans")):
        T_map_body = trajectory.at(np.array([scan.t_ns]))[0]
        parts = [_within(frames[row], scan.span_ns) for row in scan.rows]
        p_map = np.concatenate([place(part, trajectory, frames.rig) for part in parts])
        intensity = np.concatenate([part.intensity for part in parts])
        name = folder / f"scan{number:03d}"
        write_scan(name.with_suffix(SCAN_SUFFIX), T_map_body.inverse() @ p_map, intensity)
        write_pose(name.with_suffix(POSE_SUFFIX), T_map_body)
        points += len(p_map)
    return points


def _within(frame: Multiframe, span_ns: tuple[int, int]) -> Multiframe:
    t_ns = frame.t_ns + frame.dt_ns.astype(np.int64)
    return frame.take(np.flatnonzero((t_ns >= span_ns[0]) & (t_ns < span_ns[1])))
