"""Places the line scans of a profiler by the poses of a 2-D laser and the attitude by the IMU."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array, so3_exp
from recon4.kernels.imu import place_points
from recon4.live.mapper.live_attitude import LiveAttitude
from recon4.live.mapper.live_intensity import LiveIntensity
from recon4.live.mapper.tuning import SWEPT_LINES
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig


@dataclass(frozen=True, slots=True, eq=False)
class PlacedLines:
    """The points of a multiframe in the map."""

    from_m: Array
    """Position of the profiler [m], (3,)."""
    rays: Array
    """A sample of the points, for coverage [m], (N, 3)."""
    points: Array
    """A sample of the points, for the preview [m], (M, 3)."""
    values: NDArray[np.uint8]
    """Their normalized intensity, (M,)."""


class SweptLines:
    """Multiframes of a profiler wait for the poses of their time."""

    def __init__(self, rig: Rig, *, min_range_m: float) -> None:
        """Prepare.

        Args:
            rig: With a profiler.
            min_range_m: Nearer points are of the person.
        """
        row = rig.row_of("profiler")
        assert row is not None
        self._T_body_profiler = rig.sensors[row].T_body_sensor
        self._min_range_m = min_range_m
        self._intensity = LiveIntensity(len(rig.sensors))
        self._waiting: deque[Multiframe] = deque(maxlen=SWEPT_LINES.most_waiting)
        self._poses: deque[tuple[int, float, float, float]] = deque(maxlen=SWEPT_LINES.kept_poses)
        """Time [ns], turn of the attitude's heading into the map [rad], x, y [m]."""

    def push(self, frame: Multiframe) -> None:
        """Add a multiframe."""
        self._waiting.append(frame)

    def add_pose(self, t_ns: int, turn_rad: float, p_map: Array) -> None:
        """Add a pose that was tracked.

        Args:
            t_ns: Its time [ns].
            turn_rad: Rotation about z from the frame of the attitude into the map [rad].
            p_map: Position of the body [m], (2,).
        """
        self._poses.append((t_ns, turn_rad, float(p_map[0]), float(p_map[1])))

    def ready(self, attitude: LiveAttitude) -> list[PlacedLines]:
        """The multiframes whose poses are known by now."""
        found = []
        while self._waiting and self._poses:
            frame = self._waiting[0]
            if frame.t_ns + frame.duration_ns > self._poses[-1][0]:
                break
            self._waiting.popleft()
            placed = self._placed(frame, attitude)
            if placed is not None:
                found.append(placed)
        return found

    def _placed(self, frame: Multiframe, attitude: LiveAttitude) -> PlacedLines | None:
        """The points in the map; None = the poses or the attitude of their time are missing."""
        end_ns = frame.t_ns + frame.duration_ns
        poses = np.array([row[1:] for row in self._poses])
        t_ns = np.array([row[0] for row in self._poses], np.int64)
        first = int(np.searchsorted(t_ns, frame.t_ns, side="right")) - 1
        last = int(np.searchsorted(t_ns, end_ns))
        if (
            first < 0
            or np.diff(t_ns[first : last + 1]).max(initial=0) > SWEPT_LINES.longest_hole_ns
        ):
            return None
        if not attitude.covers(frame.t_ns, end_ns):
            return None
        away_m = np.linalg.norm(frame.xyz, axis=1)
        rows = np.flatnonzero(away_m >= self._min_range_m)
        if not len(rows):
            return None
        rows = rows[:: max(1, len(rows) // SWEPT_LINES.preview_points)]
        part = frame.take(rows)
        knot_ns = np.arange(
            frame.t_ns, end_ns + SWEPT_LINES.knot_ns, SWEPT_LINES.knot_ns, dtype=np.int64
        )
        known_s: Array = (t_ns - frame.t_ns).astype(np.float64) * 1e-9
        knot_s: Array = (knot_ns - frame.t_ns).astype(np.float64) * 1e-9
        turn = np.interp(knot_s, known_s, np.unwrap(poses[:, 0]))
        R = (
            so3_exp(np.outer(turn, [0.0, 0.0, 1.0]))
            @ attitude.trajectory().at(knot_ns, slack_ns=SWEPT_LINES.longest_hole_ns).R
        )
        p = np.zeros((len(knot_s), 3))
        for axis in (0, 1):
            p[:, axis] = np.interp(knot_s, known_s, poses[:, 1 + axis])
        T = self._T_body_profiler
        p_body = part.xyz.astype(np.float64) @ T.R.T + T.t
        dt_s: Array = part.dt_ns.astype(np.float64) * 1e-9
        p_map = place_points(knot_s, R, p, dt_s, p_body)
        values = self._intensity.normalize(
            part.intensity, part.sensor, part.ring, range_m=away_m[rows].astype(np.float64)
        )
        middle = len(knot_s) // 2
        step = max(1, len(p_map) // SWEPT_LINES.coverage_rays)
        return PlacedLines(R[middle] @ T.t + p[middle], p_map[::step], p_map, values)
