"""Single multiframes with all their points, placed by the trajectory."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import OutOfRange
from recon4.geometry.se3 import SE3, Array
from recon4.mapping.undistort import place
from recon4.model.trajectory import Times, Trajectory
from recon4.store.frames import FrameStore
from recon4_app.viewer.client.view import ColorBy
from recon4_app.viewer.cloud.palette import Palette, Range, usual_range
from recon4_app.viewer.cloud.parts import colors
from recon4_app.viewer.scene.nodes import PointsNode
from recon4_app.viewer.tuning import MULTIFRAMES

IN_THE_MAP_ONLY: frozenset[ColorBy] = frozenset({"normalized intensity", "uncertainty"})


class Multiframes:
    """The multiframes of a recording, to be shown one by one."""

    def __init__(self, frames: FrameStore) -> None:
        self._frames = frames
        self.t_mid_ns: Times = frames.t_mid_ns
        self.sensors = tuple(sensor.name for sensor in frames.rig.sensors)
        self.T_body_sensor: SE3 = frames.rig.T_body_sensor

    def __len__(self) -> int:
        return len(self._frames)

    def pose(self, moment: int, line: Trajectory) -> SE3 | None:
        """``T_map_body`` in the middle of a multiframe; None outside the trajectory."""
        t_ns = self.t_mid_ns[min(moment, len(self) - 1)]
        try:
            return line.at(np.array([t_ns]), slack_ns=200_000_000)[0]
        except OutOfRange:
            return None

    def at_time(self, since_start_s: float) -> int:
        """The first multiframe whose middle is not before a time after the first one [s]."""
        t_ns = self.t_mid_ns[0] + round(1e9 * since_start_s)
        return min(int(np.searchsorted(self.t_mid_ns, t_ns)), len(self) - 1)

    def window(self, moment: int, window_s: float) -> range:
        """Rows of the multiframes from one on, as long as a window."""
        first = min(moment, len(self) - 1)
        until_ns = self.t_mid_ns[first] + round(window_s * 1e9)
        return range(first, max(int(np.searchsorted(self.t_mid_ns, until_ns, "right")), first + 1))

    def thinned(self, row: int, line: Trajectory, *, most: int) -> Array:
        """Some of the points of one multiframe in the map [m], (N, 3); none off the trajectory."""
        frame = self._frames[row]
        frame = frame.take(slice(None, None, max(1, -(-len(frame) // most))))
        try:
            return place(frame, line, self._frames.rig, slack_ns=MULTIFRAMES.slack_ns)
        except OutOfRange:
            return np.empty((0, 3))

    def read(self, moment: int, window_s: float, line: Trajectory) -> MultiframeWindow | None:
        """The points of a window; None outside the trajectory."""
        rows = self.window(moment, window_s)
        total = sum(len(self._frames[k]) for k in rows)
        step = max(1, -(-total // MULTIFRAMES.max_points))
        parts = []
        for k in rows:
            frame = self._frames[k].take(slice(None, None, step))
            try:
                p_map = place(frame, line, self._frames.rig, slack_ns=MULTIFRAMES.slack_ns)
            except OutOfRange:
                continue
            t_ns = frame.t_ns + frame.dt_ns.astype(np.int64)
            number = np.full(len(frame), frame.frame_id)
            range_m = np.linalg.norm(frame.xyz, axis=1)
            parts.append((p_map, frame.intensity, t_ns, frame.sensor, frame.ring, number, range_m))
        if not parts:
            return None
        return MultiframeWindow(*(np.concatenate(column) for column in zip(*parts, strict=True)))


@dataclass(frozen=True, slots=True, eq=False)
class MultiframeWindow:
    """Points of some multiframes in the map, with their attributes."""

    p_map: Array
    """[m], (N, 3)"""
    intensity: NDArray[Any]
    t_ns: Times
    sensor: NDArray[Any]
    ring: NDArray[Any]
    frame_id: NDArray[Any]
    range_m: NDArray[Any]

    def node(
        self, color_by: ColorBy | None, *, palette: Palette, span: Range | None, size_m: float
    ) -> PointsNode:
        """The points, colored by a value; None = in one color, to stand out from the map.

        Normalized intensity and uncertainty are known in the map only: the raw intensity stands in.
        """
        origin = self.p_map[0]
        if color_by is None:
            rgb = np.tile(np.array(MULTIFRAMES.highlight, np.uint8), (len(self.p_map), 1))
        else:
            values = self._values(color_by)
            known = None if color_by in IN_THE_MAP_ONLY else span
            rgb = colors(values, color_by, span=known or usual_range(values), palette=palette)
        return PointsNode(
            path="/multiframe",
            position_m=origin,
            p_node=(self.p_map - origin).astype(np.float32),
            rgb=rgb,
            size_m=size_m,
        )

    def _values(self, color_by: ColorBy) -> NDArray[Any]:
        match color_by:
            case "normalized intensity" | "uncertainty" | "raw intensity":
                return self.intensity
            case "height":
                return self.p_map[:, 2]
            case "time":
                return (self.t_ns - self.t_ns.min()) * 1e-9
            case "sensor":
                return self.sensor
            case "ring":
                return self.ring
            case "multiframe":
                return self.frame_id
            case "distance":
                return self.range_m
