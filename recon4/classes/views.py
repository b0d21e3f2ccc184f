"""Scans of a walk at regular times, as images of ranges: what they see through does not stand."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from recon4.classes.tuning import VIEWS
from recon4.kernels.free_space import NO_SURFACE, Sights, nearest_ranges
from recon4.kernels.seen_through import RangeViews
from recon4.mapping.mirrors import Mirror, Sight, reflections
from recon4.mapping.undistort import place_with_origins
from recon4.model.frames import RecordedFrames
from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig
from recon4.model.trajectory import Times, Trajectory


class RegularViews:
    """Scans at regular times; those near to the multiframe in work are in memory, some eighty."""

    def __init__(
        self,
        frames: RecordedFrames,
        trajectory: Trajectory,
        *,
        mirrors: Sequence[Mirror],
        every_ns: int = VIEWS.every_ns,
    ) -> None:
        """Nothing is read yet.

        Args:
            frames: The multiframes.
            trajectory: ``T_map_body``, dense.
            mirrors: Their reflections are not in the images: a beam to one passes through nothing
                behind the mirror.
            every_ns: Time between two scans [ns].
        """
        self._frames, self._trajectory, self._mirrors = frames, trajectory, mirrors
        slots = (frames.t_mid_ns - frames.t_mid_ns[:1]) // every_ns
        self._rows = np.unique(slots, return_index=True)[1]
        self._t_ns: Times = frames.t_mid_ns[self._rows]
        sensors, most_ns = len(frames.rig.sensors), 2 * VIEWS.far_ns + VIEWS.kept_ns
        room = min(most_ns // every_ns + 2, len(self._rows))
        self._R, self._t = np.empty((room, sensors, 3, 3)), np.empty((room, sensors, 3))
        self._images = np.empty((room, sensors, *image_shape(frames.rig)), np.float32)
        self._slopes = np.empty((room, sensors, 2))
        self._free = list(range(room))
        self._place: dict[int, int] = {}

    def renew(self) -> None:
        """Forget all images: those that `near` returned stay as they are, in memory of their own.

        For a jump in time: threads may still read what would be overwritten.
        """
        self._R, self._t = np.empty_like(self._R), np.empty_like(self._t)
        self._images, self._slopes = np.empty_like(self._images), np.empty_like(self._slopes)
        self._free = list(range(len(self._images)))
        self._place = {}

    def near(self, t_ns: int) -> RangeViews | None:
        """The scans that points of a time are compared with; None = there are none.

        Those of the last calls stay valid while the times grow by less than `ViewTuning.kept_ns`:
        threads may read them. Who reads only the last ones asks for any time.

        Args:
            t_ns: When the points were measured [ns].
        """
        away_ns = np.abs(self._t_ns - t_ns)
        near = np.flatnonzero((away_ns >= VIEWS.apart_ns) & (away_ns <= VIEWS.far_ns))
        if not len(near):
            return None
        for old in [k for k in self._place if away_ns[k] > VIEWS.far_ns + VIEWS.kept_ns]:
            self._free.append(self._place.pop(old))
        for k in near.tolist():
            if k not in self._place:
                self._place[k] = self._free.pop()
                self._fill(self._place[k], int(self._rows[k]))
        place = np.zeros(len(self._t_ns), np.int64)
        place[near] = [self._place[k] for k in near.tolist()]
        asked = near[away_ns[near] <= VIEWS.reach_ns]
        asked = asked[np.argsort(np.abs(away_ns[asked] - VIEWS.best_ns), kind="stable")]
        before, after = near[self._t_ns[near] < t_ns], near[self._t_ns[near] > t_ns]
        orders = place[asked], place[before], place[after[::-1]]
        return RangeViews(*orders, Sights(self._R, self._t, self._images), self._slopes)

    def _fill(self, place_of_it: int, row: int) -> None:
        frame, rig = self._frames[row], self._frames.rig
        T_map_body = self._trajectory.at(np.array([frame.t_mid_ns]), slack_ns=frame.duration_ns)
        T_map_sensor = T_map_body @ rig.T_body_sensor
        self._R[place_of_it], self._t[place_of_it] = T_map_sensor.R, T_map_sensor.t
        placed = place_with_origins(frame, self._trajectory, rig)
        direct = ~reflections(self._mirrors, Sight(placed.xyz_m, placed.origin_m))
        images = self._images[place_of_it]
        images.fill(NO_SURFACE)
        for sensor, image in enumerate(images):
            T = T_map_sensor[sensor]
            nearest_ranges(placed.xyz_m[direct & (frame.sensor == sensor)], T.R, T.t, image)
            self._slopes[place_of_it, sensor] = _slopes(image)


def image_shape(rig: Rig) -> tuple[int, int]:
    """Rows (elevation) and columns (azimuth) of the images of a rig's sensors."""
    steps_deg = [lidar_model(sensor.model).ring_step_deg for sensor in rig.sensors]
    rows = round(180.0 / max(VIEWS.rows_deg, *steps_deg))
    return rows, 2 * rows * VIEWS.columns


def _slopes(image: NDArray[np.float32]) -> tuple[float, float]:
    """Least and largest slope, z through x and y, of an image's rows with returns and around."""
    seen = np.flatnonzero(np.isfinite(image).any(axis=1))
    if not len(seen):
        return np.inf, -np.inf
    edges = np.clip([seen[0] - 1, seen[-1] + 2], 1, len(image) - 1)
    low, high = np.tan(np.pi * (edges / len(image) - 0.5)).tolist()
    return (low if seen[0] > 1 else -np.inf), (high if seen[-1] < len(image) - 2 else np.inf)
