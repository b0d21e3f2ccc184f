"""Detects the floor of a building from the height of the body."""

from __future__ import annotations

APART_M = 2.0
"""Height difference to all known floors at which a new floor starts."""
_NEARER_M = 0.5
"""Hysteresis: another floor must be nearer by this, so that stairs do not toggle the floor."""
_FOLLOW = 0.005
"""Gain of the floor height per multiframe (time constant 20 s): a street that rises gently stays
one floor, stairs are faster."""


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
        if not away_m or min(away_m) > APART_M:
            self._heights_m.append(z_m)
            self.now = len(self._heights_m) - 1
            return self.now
        nearest = away_m.index(min(away_m))
        if away_m[nearest] < away_m[self.now] - _NEARER_M:
            self.now = nearest
        self._heights_m[self.now] += _FOLLOW * (z_m - self._heights_m[self.now])
        return self.now
