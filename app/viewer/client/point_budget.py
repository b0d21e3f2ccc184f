"""How many points one browser is given.

How many it can take is not known beforehand: without a graphics card it draws some 400 000 a
second, with one it draws millions at once. So it begins with few, and gets twice as many as long as
it still answers quickly.
"""

from __future__ import annotations

PHONE_POINTS = 300_000
"""A phone gets at most so many."""
FIRST_POINTS = 200_000
"""So many are sent before it is known how quick the browser is."""
FEWEST_POINTS = 60_000
QUICK_S = 0.25
"""A browser that answers within that has time for more [s]."""
SLOW_S = 0.7
"""One that takes longer is given less [s]."""
HOLD_S = 3.0
"""An answer is not waited for longer than that [s]."""


class PointBudget:
    """How many points one browser is given."""

    def __init__(self, most: int) -> None:
        self._calm_s = 0.0
        self._most = -1
        self.allow(most)

    def began(self, answer_s: float | None) -> None:
        """Told how long an answer takes when there is nothing to draw (the way there and back)."""
        self._calm_s = answer_s or 0.0

    def allow(self, most: int) -> None:
        """The person, or the server, allows so many; what was learnt is forgotten."""
        if most != self._most:
            self._most = self._ceiling = most
            self.points = min(FIRST_POINTS, most)
            self.settled = self.points == most

    def record(self, answer_s: float | None) -> None:
        """Told how long an answer took (None = too long) with `points` on screen."""
        before = self.points
        if answer_s is None:
            self.points = max(before // 2, min(FEWEST_POINTS, self._most))
        elif answer_s - self._calm_s > SLOW_S:
            self._ceiling = max(before // 2, min(FEWEST_POINTS, self._most))
            self.points = self._ceiling
        elif answer_s - self._calm_s < QUICK_S:
            self.points = min(before * 2, self._ceiling)
        self.settled = self.points == before
