"""The number of points sent to one browser.

Its capacity is not known beforehand: without a graphics card it draws some 400 000 points a second,
with one it draws millions at once. So the budget begins small, and doubles as long as the browser
responds quickly.
"""

from __future__ import annotations

from recon4_app.viewer.tuning import POINT_BUDGET


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
            self.points = min(POINT_BUDGET.first_points, most)
            self.settled = self.points == most

    def record(self, answer_s: float | None) -> None:
        """Adapt to a response time (None = too long) measured with `points` on screen."""
        before = self.points
        if answer_s is None:
            self.points = max(before // 2, min(POINT_BUDGET.fewest_points, self._most))
        elif answer_s - self._calm_s > POINT_BUDGET.slow_s:
            self._ceiling = max(before // 2, min(POINT_BUDGET.fewest_points, self._most))
            self.points = self._ceiling
        elif answer_s - self._calm_s < POINT_BUDGET.quick_s:
            self.points = min(before * 2, self._ceiling)
        self.settled = self.points == before
