"""Multiframes wait for the IMU samples of their time, but not for long."""

from __future__ import annotations

from collections import deque

from recon4.model.multiframe import Multiframe

MOST_WAITING = 3
"""An IMU that is late by more than so many multiframes, or silent, is not waited for."""
_SURE_NS = 10_000_000
"""The motion of the last milliseconds of a frame may be continued."""


class ImuSynchronization:
    """Holds multiframes back until the IMU has told of their end."""

    def __init__(self) -> None:
        self._waiting: deque[Multiframe] = deque()
        self._imu_ns: int | None = None

    def heard(self, t_ns: int) -> list[Multiframe]:
        """The IMU has told of all until then [ns]; gives the multiframes to be mapped now."""
        self._imu_ns = t_ns
        return self._ready()

    def came(self, frame: Multiframe) -> list[Multiframe]:
        """A multiframe was cut; gives those to be mapped now."""
        self._waiting.append(frame)
        return self._ready()

    def rest(self) -> list[Multiframe]:
        """Those that still wait when nothing more will come."""
        frames = list(self._waiting)
        self._waiting.clear()
        return frames

    def _ready(self) -> list[Multiframe]:
        ready = []
        while self._waiting and (self._in_step() or len(self._waiting) > MOST_WAITING):
            ready.append(self._waiting.popleft())
        return ready

    def _in_step(self) -> bool:
        frame = self._waiting[0]
        end_ns = frame.t_ns + frame.duration_ns
        return self._imu_ns is None or self._imu_ns >= end_ns - _SURE_NS
