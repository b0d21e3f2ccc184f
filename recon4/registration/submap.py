"""The segments of a few multiframes around a node of the pose graph, in the node's body frame."""

from __future__ import annotations

import os
import tempfile
from collections import OrderedDict
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.imu import place_points
from recon4.model.frames import RecordedFrames
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.overlap import make_range_image
from recon4.registration.segments import Segments, sample_segments
from recon4.settings import Settings

_CACHED_FRAMES = 64

Ends = NDArray[np.float64]
"""Both ends of M segments [m], (M, 2, 3)."""


class Submaps:
    """Computes the segments around nodes on demand; the last frames stay in a small cache.

    Not thread-safe: each thread creates its own.
    """

    def __init__(
        self,
        frames: RecordedFrames,
        odometry: Trajectory,
        rows: NDArray[np.intp],
        *,
        settings: Settings,
        skip: NDArray[np.bool_],
    ) -> None:
        self._frames, self._odometry, self._settings = frames, odometry, settings
        self._rows = rows
        self._skip = skip
        self._cache: OrderedDict[int, Ends] = OrderedDict()
        self._t_ns = frames.t_mid_ns[rows]

    def around(self, node: int, reach: int) -> Ends:
        """Segments of the multiframes up to ``reach`` before and after the node's own."""
        row = int(self._rows[node])
        near = range(max(row - reach, 0), min(row + reach + 1, len(self._frames)))
        parts = [self._ends_odom(k) for k in near if not self._skip[k]]
        ends = np.concatenate(parts) if parts else np.empty((0, 2, 3))
        T_odom_body = self._odometry.at(self._t_ns[node : node + 1])[0]
        # Flattened: numpy multiplies a stack of 2 x 3 matrices one by one.
        return (T_odom_body.inverse() @ ends.reshape(-1, 3)).reshape(-1, 2, 3)

    def points_of(self, node: int) -> Array:
        """All points of the node's multiframe, undistorted, in its body frame [m], (N, 3)."""
        frame, rig = self._frames[int(self._rows[node])], self._frames.rig
        part = _covering(self._odometry, frame.t_ns, frame.duration_ns)
        t_s = (part.t_ns - frame.t_ns).astype(np.float64) * 1e-9
        dt_s = frame.dt_ns.astype(np.float64) * 1e-9
        placed = [np.empty((0, 3))]
        for row, sensor in enumerate(rig.sensors):
            of_sensor = frame.sensor == row
            if sensor.enabled:
                p_body = sensor.T_body_sensor @ frame.xyz[of_sensor].astype(np.float64)
                T = part.T_a_b
                placed.append(place_points(t_s, T.R, T.t, dt_s[of_sensor], p_body))
        T_odom_body = self._odometry.at(self._t_ns[node : node + 1])[0]
        return T_odom_body.inverse() @ np.concatenate(placed)

    def _ends_odom(self, row: int) -> Ends:
        if row in self._cache:
            self._cache.move_to_end(row)
            return self._cache[row]
        frame = self._frames[row]
        segments = sample_segments(frame, self._frames.rig, self._settings.segments)
        ends = place_segments(segments, frame.t_ns, frame.duration_ns, trajectory=self._odometry)
        self._cache[row] = ends
        if len(self._cache) > _CACHED_FRAMES:
            self._cache.popitem(last=False)
        return ends


def place_segments(
    segments: Segments, t_ns: int, duration_ns: int, *, trajectory: Trajectory
) -> Ends:
    """Both ends of each segment, placed by the pose at their times, in the trajectory's frame."""
    part = _covering(trajectory, t_ns, duration_ns)
    t_s = (part.t_ns - t_ns).astype(np.float64) * 1e-9
    T = part.T_a_b
    return np.stack(
        [
            place_points(t_s, T.R, T.t, segments.a_s, segments.a_body),
            place_points(t_s, T.R, T.t, segments.b_s, segments.b_body),
        ],
        axis=1,
    )


def _covering(trajectory: Trajectory, t_ns: int, duration_ns: int) -> Trajectory:
    """The poses over one frame, with one more before and after."""
    first, last = np.searchsorted(trajectory.t_ns, [t_ns, t_ns + duration_ns])
    first = min(max(int(first) - 1, 0), len(trajectory) - 2)
    return trajectory[slice(first, max(int(last) + 1, first + 2))]


class NodeRangeImages:
    """Segments and range image of each node, for the registration of pairs; kept on disk.

    Args:
        count: Number of nodes.
        settings: Uses graph and overlap.
        scratch: Folder for the unnamed temporary files; a full disk raises OSError.
    """

    def __init__(self, count: int, settings: Settings, scratch: Path) -> None:
        g, o = settings.graph, settings.overlap
        self._size = np.zeros(count, np.int64)
        self._ends = _scratch((count, g.source_segments, 2, 3), scratch)
        self._nearest = _scratch((count, o.azimuth_bins, o.elevation_bins), scratch)
        self._settings = settings

    def fill(self, submaps: Submaps, nodes: Sequence[int]) -> None:
        """Compute segments and range images of some nodes."""
        g = self._settings.graph
        for node in nodes:
            # The segments of one multiframe are too few points to fill the bins of a view volume.
            wide = (
                submaps.around(node, g.target_reach).reshape(-1, 3)
                if g.target_reach
                else submaps.points_of(node)
            )
            near = _thin(submaps.around(node, g.source_reach), g.source_segments)
            self._size[node] = len(near)
            self._ends[node, : len(near)] = near
            view = make_range_image(wide, self._settings.overlap)
            self._nearest[node] = view.nearest_m

    def ends(self, node: int) -> Ends:
        """Both ends of the node's segments, thinned evenly [m], (M, 2, 3)."""
        return self._ends[node, : self._size[node]].astype(np.float64)

    def nearest_m(self, node: int) -> NDArray[np.float32]:
        """The spherical z-buffer of the node, see `overlap.View`."""
        return np.asarray(self._nearest[node])


def _thin(ends: Ends, limit: int) -> Ends:
    if len(ends) <= limit:
        return ends
    return ends[np.linspace(0, len(ends) - 1, limit).astype(np.intp)]


def _scratch(shape: tuple[int, ...], folder: Path) -> NDArray[np.float32]:
    """An array in an unnamed file that is removed with the array."""
    with tempfile.TemporaryFile(dir=folder) as file:
        # Writing a sparse file through a memory map kills the process if the disk is full.
        os.posix_fallocate(file.fileno(), 0, 4 * int(np.prod(shape)))
        return np.memmap(file, np.float32, "r+", shape=shape)


def median_range_m(ends: Array) -> float:
    """Median distance of segments from the node [m] (for V Eq. 2.7)."""
    return float(np.median(np.linalg.norm(ends[:, 0], axis=1))) if len(ends) else 0.0


def node_rows(t_ns: Times, stride: int, skip: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Multiframes that become nodes: every ``stride``-th that is not lost.

    At least one: the first that is not lost, or the very first if all of them are.
    """
    rows = np.arange(min(stride // 2, max(len(t_ns) - 1, 0)), len(t_ns), stride)
    kept = rows[~skip[rows]]
    return kept if len(kept) else np.append(np.flatnonzero(~skip), 0)[:1]
