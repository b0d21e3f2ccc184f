"""Multiframes wait for the IMU samples of their time, for a limited time."""

from __future__ import annotations

from collections import deque

from recon4.model.multiframe import Multiframe

MAX_WAITING = 3
"""Multiframes that wait at most; an IMU that is later than this or silent is not waited for."""
_SURE_NS = 10_000_000
"""Samples may be missing for this part at the end of a frame; its motion is extrapolated."""


class ImuSynchronization:
    """Queues multiframes until the IMU samples until their end are there."""

    def __init__(self) -> None:
        self._waiting: deque[Multiframe] = deque()
        self._imu_ns: int | None = None

    def imu_until(self, t_ns: int) -> list[Multiframe]:
        """Note that all IMU samples until a time [ns] are there; returns multiframes to map now."""
        self._imu_ns = t_ns
        return self._ready()

    def push(self, frame: Multiframe) -> list[Multiframe]:
        """Add a multiframe; returns the multiframes to map now."""
        self._waiting.append(frame)
        return self._ready()

    def flush(self) -> list[Multiframe]:
        """Return the multiframes that still wait at the end of the capture."""
        frames = list(self._waiting)
        self._waiting.clear()
        return frames

    def _ready(self) -> list[Multiframe]:
        ready = []
        while self._waiting and (self._synchronized() or len(self._waiting) > MAX_WAITING):
            ready.append(self._waiting.popleft())
        return ready

    def _synchronized(self) -> bool:
        frame = self._waiting[0]
        end_ns = frame.t_ns + frame.duration_ns
        return self._imu_ns is None or self._imu_ns >= end_ns - _SURE_NS
