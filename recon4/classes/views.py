"""Scans of a walk at regular times, as images of ranges: what they see through does not stand."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.classes.tuning import VIEWS
from recon4.geometry.se3 import Array
from recon4.kernels.free_space import NO_SURFACE, nearest_ranges
from recon4.kernels.seen_through import RangeViews
from recon4.mapping.undistort import place
from recon4.model.frames import RecordedFrames
from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig
from recon4.model.trajectory import Times, Trajectory


class RegularViews:
    """Scans at regular times; those near to the multiframe in work are in memory, some forty."""

    def __init__(self, frames: RecordedFrames, trajectory: Trajectory) -> None:
        """Nothing is read yet.

        Args:
            frames: The multiframes.
            trajectory: ``T_map_body``, dense.
        """
        self._frames, self._trajectory = frames, trajectory
        slots = (frames.t_mid_ns - frames.t_mid_ns[:1]) // VIEWS.every_ns
        self._rows = np.unique(slots, return_index=True)[1]
        self._t_ns: Times = frames.t_mid_ns[self._rows]
        sensors, room = len(frames.rig.sensors), 2 * VIEWS.kept_ns // VIEWS.every_ns + 2
        room = min(room, len(self._rows))
        self._R, self._t = np.empty((room, sensors, 3, 3)), np.empty((room, sensors, 3))
        self._images = np.empty((room, sensors, *image_shape(frames.rig)), np.float32)
        self._free = list(range(room))
        self._place: dict[int, int] = {}

    def near(self, t_ns: int) -> RangeViews | None:
        """The scans that points of a time are compared with; None = there are none.

        Those of the last calls stay valid while the times grow by less than a second.

        Args:
            t_ns: Not before that of the last call [ns].
        """
        away_ns = np.abs(self._t_ns - t_ns)
        near = np.flatnonzero((away_ns >= VIEWS.apart_ns) & (away_ns <= VIEWS.reach_ns))
        near = near[np.argsort(np.abs(away_ns[near] - VIEWS.best_ns), kind="stable")]
        for old in [k for k in self._place if away_ns[k] > VIEWS.kept_ns]:
            self._free.append(self._place.pop(old))
        for k in near.tolist():
            if k not in self._place:
                self._place[k] = self._free.pop()
                self._fill(self._place[k], int(self._rows[k]))
        if not len(near):
            return None
        return RangeViews(
            np.array([self._place[k] for k in near.tolist()]), self._R, self._t, self._images
        )

    def _fill(self, place_of_it: int, row: int) -> None:
        frame, rig = self._frames[row], self._frames.rig
        T_map_body = self._trajectory.at(np.array([frame.t_mid_ns]), slack_ns=frame.duration_ns)
        T_map_sensor = T_map_body @ rig.T_body_sensor
        self._R[place_of_it], self._t[place_of_it] = T_map_sensor.R, T_map_sensor.t
        p_map = place(frame, self._trajectory, rig)
        images = self._images[place_of_it]
        images.fill(NO_SURFACE)
        for sensor, image in enumerate(images):
            T = T_map_sensor[sensor]
            nearest_ranges(p_map[frame.sensor == sensor], T.R, T.t, image)


def image_shape(rig: Rig) -> tuple[int, int]:
    """Rows (elevation) and columns (azimuth) of the images of a rig's sensors."""
    steps_deg = [lidar_model(sensor.model).ring_step_deg for sensor in rig.sensors]
    rows = round(180.0 / max(VIEWS.rows_deg, *steps_deg))
    return rows, 2 * rows * VIEWS.columns


def in_body(frame_xyz: NDArray[np.float32], sensor: NDArray[np.uint8], rig: Rig) -> Array:
    """Points of sensors in the body [m], each at its time, (N, 3)."""
    body = np.empty((len(sensor), 3))
    for number, one in enumerate(rig.sensors):
        mine = sensor == number
        body[mine] = one.T_body_sensor @ frame_xyz[mine].astype(np.float64)
    return body
