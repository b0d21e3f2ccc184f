"""Multiframes and scans wait for the IMU samples of their time, for a limited time."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

from recon4.live.mapper.tuning import IMU_WAIT

Measured = TypeVar("Measured")


class ImuSynchronization(Generic[Measured]):
    """Queues multiframes or scans until the IMU samples until their end are there."""

    def __init__(
        self, end_ns: Callable[[Measured], int], *, most: int = IMU_WAIT.max_waiting
    ) -> None:
        """Prepare.

        Args:
            end_ns: End of one [ns].
            most: How many wait at most.
        """
        self.end_ns, self._most = end_ns, most
        self._waiting: deque[Measured] = deque()
        self._imu_ns: int | None = None

    def imu_until(self, t_ns: int) -> list[Measured]:
        """Note that all IMU samples until a time [ns] are there; returns what to map now."""
        self._imu_ns = t_ns
        return self._ready()

    def push(self, frame: Measured) -> list[Measured]:
        """Add a multiframe or scan; returns what to map now."""
        self._waiting.append(frame)
        return self._ready()

    def flush(self) -> list[Measured]:
        """Return what still waits at the end of the capture."""
        frames = list(self._waiting)
        self._waiting.clear()
        return frames

    def _ready(self) -> list[Measured]:
        ready = []
        while self._waiting and (self._synchronized() or len(self._waiting) > self._most):
            ready.append(self._waiting.popleft())
        return ready

    def _synchronized(self) -> bool:
        end_ns = self.end_ns(self._waiting[0])
        return self._imu_ns is None or self._imu_ns >= end_ns - IMU_WAIT.sure_ns
