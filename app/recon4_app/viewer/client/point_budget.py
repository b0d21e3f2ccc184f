"""The number of points sent to one browser.

Its capacity is not known beforehand: without a graphics card it draws some 400 000 points a second,
with one it draws millions at once. So the budget begins small, and doubles as long as the browser
responds quickly.
"""

from __future__ import annotations

PHONE_POINTS = 300_000
"""Most points on a phone."""
FIRST_POINTS = 200_000
"""Points before the speed of the browser is known."""
FEWEST_POINTS = 60_000
QUICK_S = 0.25
"""Response time below which the budget grows [s]."""
SLOW_S = 0.7
"""Response time above which the budget shrinks [s]."""
HOLD_S = 3.0
"""Longest wait for a response [s]."""


class PointBudget:
    """Adapts the number of points of one browser to its response time."""

    def __init__(self, most: int) -> None:
        self._calm_s = 0.0
        self._most = -1
        self.allow(most)

    def began(self, answer_s: float | None) -> None:
        """Set the response time when there is nothing to draw (the round trip)."""
        self._calm_s = answer_s or 0.0

    def allow(self, most: int) -> None:
        """Set the limit of the person or the server; a new limit resets the adaptation."""
        if most != self._most:
            self._most = self._ceiling = most
            self.points = min(FIRST_POINTS, most)
            self.settled = self.points == most

    def record(self, answer_s: float | None) -> None:
        """Adapt to a response time (None = too long) measured with `points` on screen."""
        before = self.points
        if answer_s is None:
            self.points = max(before // 2, min(FEWEST_POINTS, self._most))
        elif answer_s - self._calm_s > SLOW_S:
            self._ceiling = max(before // 2, min(FEWEST_POINTS, self._most))
            self.points = self._ceiling
        elif answer_s - self._calm_s < QUICK_S:
            self.points = min(before * 2, self._ceiling)
        self.settled = self.points == before
