"""Which floor of a building the body is on, told by its height alone."""

from __future__ import annotations

APART_M = 2.0
"""So far from all floors known is a new one."""
_NEARER_M = 0.5
"""Another floor is changed to when it is nearer by that: halfway up the stairs nothing flickers."""
_FOLLOW = 0.005
"""Share a floor's height follows the body each multiframe: 20 s. A street may rise gently all
along and stay one floor; stairs are quicker than that."""


class Floors:
    """Floors in the order in which they were come to."""

    def __init__(self) -> None:
        self._heights_m: list[float] = []
        self.now = 0
        """Number of the floor the body was on last."""

    def __len__(self) -> int:
        return len(self._heights_m)

    def at(self, z_m: float) -> int:
        """The floor of a body at a height [m]; call it for every multiframe."""
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
