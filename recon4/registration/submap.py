"""The segments of a few multiframes around a node of the pose graph, in the node's body frame."""

from __future__ import annotations

import os
import tempfile
import threading
import weakref
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.imu import place_points
from recon4.kernels.points import transform_points
from recon4.model.frames import RecordedFrames
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.in_body import in_body
from recon4.registration.segments import Segments, sample_segments

Ends = NDArray[np.float64]
"""Both ends of M segments [m], (M, 2, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class TrackedFrames:
    """Multiframes and their poses by odometry."""

    frames: RecordedFrames
    trajectory: Trajectory
    """``T_odom_body``, dense."""
    lost: NDArray[np.bool_]
    """Multiframes without a pose, which have no segments here, (F,)."""


class Submaps:
    """Computes the segments around nodes on demand.

    The segments of a multiframe are drawn once and kept in an unnamed file, for all nodes and
    all threads.
    """

    def __init__(self, tracked: TrackedFrames, rows: NDArray[np.intp], *, scratch: Path) -> None:
        """Nothing is drawn yet.

        Args:
            tracked: The multiframes.
            rows: Multiframe of each node, (N,).
            scratch: Folder for the unnamed file; a full disk raises OSError.
        """
        self._frames, self._odometry = tracked.frames, tracked.trajectory
        self._lost = tracked.lost
        self._rows = rows
        self._T_odom_frame = tracked.trajectory.at(tracked.frames.t_mid_ns)
        self._drawn = _DrawnEnds(scratch)

    def around(self, node: int, reach: int) -> Ends:
        """Segments of the multiframes up to ``reach`` before and after the node's own."""
        row = int(self._rows[node])
        near = range(max(row - reach, 0), min(row + reach + 1, len(self._frames)))
        parts = [(k, self._ends_of(k)) for k in near if not self._lost[k]]
        ends = np.empty((sum(len(part) for _, part in parts), 2, 3))
        T_node_odom, filled = self._T_odom_frame[row].inverse(), 0
        for k, part in parts:
            T = T_node_odom @ self._T_odom_frame[k]
            out = ends[filled : filled + len(part)].reshape(-1, 3)
            transform_points(T.R, T.t, part.reshape(-1, 3), out)
            filled += len(part)
        return ends

    def points_of(self, node: int) -> Array:
        """All points of the node's multiframe, undistorted, in its body frame [m], (N, 3)."""
        row, rig = int(self._rows[node]), self._frames.rig
        frame = self._frames[row]
        part = _covering(self._odometry, frame.t_ns, frame.duration_ns)
        t_s = (part.t_ns - frame.t_ns).astype(np.float64) * 1e-9
        dt_s = frame.dt_ns.astype(np.float64) * 1e-9
        placed = [np.empty((0, 3))]
        for k, sensor in enumerate(rig.sensors):
            of_sensor = frame.sensor == k
            if sensor.enabled:
                p_body = in_body(sensor, frame.xyz[of_sensor])
                T = part.T_a_b
                placed.append(place_points(t_s, T.R, T.t, dt_s[of_sensor], p_body))
        return self._T_odom_frame[row].inverse() @ np.concatenate(placed)

    def _ends_of(self, row: int) -> NDArray[np.float32]:
        """Segments of a multiframe in its body frame at its middle."""
        kept = self._drawn.read(row)
        if kept is not None:
            return kept
        frame = self._frames[row]
        segments = sample_segments(frame, self._frames.rig)
        ends = place_segments(segments, frame.t_ns, frame.duration_ns, trajectory=self._odometry)
        in_frame = self._T_odom_frame[row].inverse() @ ends.reshape(-1, 3)
        return self._drawn.write(row, in_frame.reshape(-1, 2, 3).astype(np.float32))


class _DrawnEnds:
    """Segments of multiframes in an unnamed file; several threads may use it at once."""

    def __init__(self, folder: Path) -> None:
        self._file = tempfile.TemporaryFile(dir=folder)  # noqa: SIM115
        weakref.finalize(self, self._file.close)
        self._lock = threading.Lock()
        self._places: dict[int, tuple[int, int]] = {}
        """First byte and number of segments of each multiframe that was written."""

    def read(self, row: int) -> NDArray[np.float32] | None:
        """Segments of a multiframe, (M, 2, 3); None = not written yet."""
        if row not in self._places:
            return None
        first, count = self._places[row]
        data = os.pread(self._file.fileno(), 24 * count, first)
        return np.frombuffer(data, np.float32).reshape(count, 2, 3)

    def write(self, row: int, ends: NDArray[np.float32]) -> NDArray[np.float32]:
        """Append the segments of a multiframe and return them."""
        with self._lock:
            first = self._file.seek(0, os.SEEK_END)
            self._file.write(ends.tobytes())
            self._file.flush()
        self._places[row] = (first, len(ends))
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
