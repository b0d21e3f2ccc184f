"""The path that is shown, and how much was left out lately, of any live map."""

from __future__ import annotations

from collections import deque

import numpy as np

from recon4.geometry.se3 import Array
from recon4.live.mapper.tuning import SHOWN
from recon4.live.protocol import RecentFrames


class ShownPath:
    """Places of the body, one every `SHOWN.path_step_m`."""

    def __init__(self) -> None:
        self.places: list[list[float]] = []
        """[m], to a centimeter."""

    def extend(self, p_map: Array) -> None:
        """Add a position [m], (3,), if it is far enough from the last one."""
        if not self.places or np.linalg.norm(p_map - self.places[-1]) >= SHOWN.path_step_m:
            self.places.append([round(float(v), 2) for v in p_map])


class RecentCounts:
    """Counts multiframes or scans, and those of them that are left out because of latency."""

    def __init__(self) -> None:
        self.thinned = 0
        """Left out in all."""
        self._recent: deque[tuple[int, bool]] = deque()
        """Time of each recent one [ns] and whether it was left out."""

    def add(self, t_ns: int, *, left_out: bool = False) -> None:
        """Count one."""
        self.thinned += left_out
        self._recent.append((t_ns, left_out))

    def message(self, now_ns: int) -> RecentFrames:
        """Those of the last 10 s."""
        while now_ns - self._recent[0][0] > SHOWN.recent_ns:
            self._recent.popleft()
        return RecentFrames(len(self._recent), thinned=sum(out for _, out in self._recent))
