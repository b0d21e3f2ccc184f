"""Points of multiframes that later stages do not see."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.model.multiframe import Multiframe

MOVING_POINTS = "moving.npz"
"""In the folder of the stage ``odometry``: points on moving objects, if they are left out."""


@dataclass(frozen=True, slots=True, eq=False)
class HiddenPoints:
    """Which points of each multiframe are left out, a bit each."""

    bits: NDArray[np.uint8]
    """Packed, every multiframe from a new byte on, (B,)."""
    start: NDArray[np.int64]
    """First byte of each multiframe, and the end, (N + 1,). None of a multiframe without bytes is
    left out."""

    @staticmethod
    def of(masks: Iterable[NDArray[np.bool_] | None]) -> HiddenPoints:
        """From the mask of each multiframe, True = left out; None = all of its points are seen."""
        packed = [np.empty(0, np.uint8) if m is None else np.packbits(m) for m in masks]
        start = np.cumsum([0, *map(len, packed)], dtype=np.int64)
        return HiddenPoints(np.concatenate([np.empty(0, np.uint8), *packed]), start)

    @property
    def count(self) -> int:
        """How many points are left out in all."""
        return int(np.bitwise_count(self.bits).sum())

    def seen(self, frame: Multiframe) -> Multiframe:
        """A multiframe without its hidden points."""
        first, last = self.start[frame.frame_id : frame.frame_id + 2]
        if first == last:
            return frame
        hidden = np.unpackbits(self.bits[first:last], count=len(frame)).astype(bool)
        return frame.take(np.flatnonzero(~hidden))
