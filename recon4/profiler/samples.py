"""Some points of line scans and of the 2-D laser in the body, with their times."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.imu import place_points
from recon4.model.laser_scans import LaserScans
from recon4.model.rig import Rig
from recon4.model.trajectory import Times, Trajectory
from recon4.store.frames import FrameStore


@dataclass(frozen=True, slots=True, eq=False)
class TimedPoints:
    """Points in the body of their own time, in order of time."""

    t_ns: Times
    """Time of each [ns], (N,)."""
    p_body: Array
    """[m], (N, 3)."""

    def __len__(self) -> int:
        return len(self.t_ns)

    def between(self, start_ns: int, end_ns: int) -> TimedPoints:
        """Those measured in a half-open span."""
        first, last = np.searchsorted(self.t_ns, [start_ns, end_ns])
        return TimedPoints(self.t_ns[first:last], self.p_body[first:last])

    def placed(self, trajectory: Trajectory) -> Array:
        """The points by the poses of their times: they are unwound [m], (N, 3)."""
        if not len(self):
            return np.empty((0, 3))
        first, last = np.searchsorted(trajectory.t_ns, [self.t_ns[0], self.t_ns[-1]])
        first = min(max(int(first) - 1, 0), len(trajectory) - 2)
        part = trajectory[slice(first, max(int(last) + 1, first + 2))]
        zero = int(part.t_ns[0])
        T: SE3 = part.T_a_b
        t_s = (part.t_ns - zero).astype(np.float64) * 1e-9
        return place_points(
            t_s, T.R, T.t, (self.t_ns - zero).astype(np.float64) * 1e-9, self.p_body
        )


def line_points(frames: FrameStore, row: int, *, every: int, min_range_m: float) -> TimedPoints:
    """Points of the profiler's lines in one multiframe.

    Args:
        frames: The multiframes.
        row: Of the multiframe.
        every: Only every n-th point.
        min_range_m: Nearer points are of the carrier.
    """
    frame, rig = frames[row], frames.rig
    sensor = rig.row_of("profiler")
    assert sensor is not None
    rows = np.flatnonzero(frame.sensor == sensor)[frame.frame_id % every :: every]
    xyz = frame.xyz[rows].astype(np.float64)
    kept = np.einsum("ni,ni->n", xyz, xyz) >= min_range_m**2
    p_body = rig.sensors[sensor].T_body_sensor @ xyz[kept]
    return TimedPoints(frame.t_ns + frame.dt_ns[rows[kept]].astype(np.int64), p_body)


def laser_points(
    scans: LaserScans, rig: Rig, span_ns: tuple[int, int], *, every: int
) -> TimedPoints:
    """Points of the 2-D laser in a half-open span; only every n-th beam."""
    sensor = rig.row_of("laser2d")
    first, last = np.searchsorted(scans.t_ns, span_ns)
    if sensor is None or last <= first:
        return TimedPoints(np.zeros(0, np.int64), np.empty((0, 3)))
    part = scans[slice(int(first), int(last))]
    scan = np.repeat(np.arange(len(part)), part.beams)
    beam = np.arange(len(part.range_m)) - part.start[scan]
    used = (beam % every == 0) & np.isfinite(part.range_m)
    scan, beam, ranges = scan[used], beam[used], part.range_m[used].astype(np.float64)
    angle = part.angle_min_rad[scan] + part.angle_step_rad[scan] * beam
    xyz = np.zeros((len(angle), 3))
    xyz[:, 0], xyz[:, 1] = ranges * np.cos(angle), ranges * np.sin(angle)
    t_ns = part.t_ns[scan] + np.rint(1e9 * part.time_step_s[scan] * beam).astype(np.int64)
    return TimedPoints(t_ns, rig.sensors[sensor].T_body_sensor @ xyz)


def joined(parts: list[TimedPoints]) -> TimedPoints:
    """Points of several sensors in order of time."""
    t_ns = np.concatenate([part.t_ns for part in parts])
    order = np.argsort(t_ns, kind="stable")
    return TimedPoints(t_ns[order], np.concatenate([part.p_body for part in parts])[order])


def all_lines(frames: FrameStore, *, every: int, min_range_m: float) -> Iterator[TimedPoints]:
    """Points of the lines, multiframe by multiframe."""
    for row in range(len(frames)):
        yield line_points(frames, row, every=every, min_range_m=min_range_m)
