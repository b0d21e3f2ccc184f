"""Detects the floor of a building from the height of the body."""

from __future__ import annotations

from recon4.live.preview.tuning import FLOOR_DETECTION


class Floors:
    """Floors in the order of their first visit."""

    def __init__(self) -> None:
        self._heights_m: list[float] = []
        self.now = 0
        """Number of the current floor."""

    def __len__(self) -> int:
        return len(self._heights_m)

    def at(self, z_m: float) -> int:
        """Number of the floor at a body height [m]; call it for every multiframe."""
        away_m = [abs(z_m - height_m) for height_m in self._heights_m]
        if not away_m or min(away_m) > FLOOR_DETECTION.apart_m:
            self._heights_m.append(z_m)
            self.now = len(self._heights_m) - 1
            return self.now
        nearest = away_m.index(min(away_m))
        if away_m[nearest] < away_m[self.now] - FLOOR_DETECTION.nearer_m:
            self.now = nearest
        self._heights_m[self.now] += FLOOR_DETECTION.follow * (z_m - self._heights_m[self.now])
        return self.now
