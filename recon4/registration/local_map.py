"""The map that an odometry registers to: planes and points of the last keyframes."""

from __future__ import annotations

from collections import deque

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.imu import place_points
from recon4.registration.frame_view import FrameView
from recon4.registration.plane_map import PlaneMap
from recon4.registration.point_map import PointMap
from recon4.registration.tuning import OdometryTuning
from recon4.settings.reads import OdometryReads
from recon4.settings.tuning import tuned


class LocalMap:
    """Planes of the last keyframes, and points of all that are near."""

    def __init__(self, settings: OdometryReads, *, longest: int) -> None:
        """Empty.

        Args:
            settings: Uses planes, and odometry: how far keyframes are apart.
            longest: Number of keyframes of which there are planes.
        """
        self._settings = tuned(OdometryTuning, settings.odometry)
        self._longest = longest
        self.planes = PlaneMap()
        self.points = PointMap()
        self._keyframes: deque[tuple[Array, Array]] = deque()
        """Ends of the segments of the last keyframes (N, 3), and from where they were seen (3,)."""
        self._last_keyframe = SE3.identity()

    @property
    def is_empty(self) -> bool:
        """Whether there is no keyframe with segments yet."""
        return not self._keyframes

    def clear(self) -> None:
        """Forget all keyframes."""
        self.planes.clear()
        self.points.clear()
        self._keyframes.clear()

    def needs(self, T_odom_body: SE3) -> bool:
        """Whether the body moved or turned far enough since the last keyframe."""
        o = self._settings
        T_last_now = self._last_keyframe.inverse() @ T_odom_body
        turned = np.trace(T_last_now.R) < 1.0 + 2.0 * np.cos(o.keyframe_rad)
        moved = np.linalg.norm(T_last_now.t) > o.keyframe_m or turned
        return bool(moved) or self.is_empty

    def add(self, view: FrameView, t_s: Array, T_dense: SE3) -> None:
        """Add a keyframe.

        Args:
            view: The frame.
            t_s: Times of its poses after its start [s], (K,).
            T_dense: The poses, a batch of K.
        """
        segments = view.segments
        if len(segments):
            self._last_keyframe = T_dense[-1]
            ends = (segments.a_s, segments.a_body), (segments.b_s, segments.b_body)
            placed = [place_points(t_s, T_dense.R, T_dense.t, *end) for end in ends]
            keyframe = np.concatenate(placed), T_dense.t[-1].copy()
            self.planes.add(*keyframe)
            self._keyframes.append(keyframe)
            if len(self._keyframes) > self._longest:
                self.planes.remove(*self._keyframes.popleft())
        self.points.add(view.keyframe_points(), t_s, T_dense)
