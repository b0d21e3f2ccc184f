"""One multiframe as the odometry looks at it: sampled once, however often it is fitted."""

from __future__ import annotations

from recon4.geometry.se3 import SE3, Array
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.registration.point_map import FramePoints, frame_points
from recon4.registration.scan_chain import ScanChain, body_points, times_located
from recon4.registration.segments import Segments, sample_segments
from recon4.registration.tuning import SEGMENTS, SegmentTuning
from recon4.registration.tuning_matching import SCAN_CHAIN


class FrameView:
    """A frame with its segments; its points are worked out when they are needed."""

    def __init__(self, frame: Multiframe, rig: Rig, settings: SegmentTuning = SEGMENTS) -> None:
        self.frame = frame
        self.segments: Segments = sample_segments(frame, rig, settings)
        self._rig = rig
        self._points: FramePoints | None = None

    @property
    def start_ns(self) -> int:
        """When it begins [ns]."""
        return self.frame.t_ns

    @property
    def end_ns(self) -> int:
        """When it ends [ns]."""
        return self.frame.t_ns + self.frame.duration_ns

    def points(self) -> FramePoints:
        """Points for the point map."""
        if self._points is None:
            self._points = frame_points(self.frame, self._rig)
        return self._points

    def keyframe_points(self) -> FramePoints:
        """The same in the order in which the point map adds them fastest."""
        return frame_points(self.frame, self._rig, by_ring=True)

    def scan(self, motion: SE3) -> Array:
        """All points, in the body [m], (N, 3); those of a rosette as of its middle.

        Args:
            motion: Of the body over the frame.
        """
        return body_points(self.frame, self._rig, motion)

    def locate_in(self, chain: ScanChain) -> SE3 | None:
        """Pose in the last good scan of a chain, or None; what was distorted is undistorted."""
        before = chain.motion
        for _ in range(times_located(self._rig)):
            found = chain.locate(self.scan(before), self.frame.t_mid_ns)
            if found is None or not (before.inverse() @ found).moves_more_than(
                SCAN_CHAIN.settled_m
            ):
                break
            before = found
        return found
