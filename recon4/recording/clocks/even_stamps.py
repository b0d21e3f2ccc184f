"""Clouds that are stamped as they arrive: the sensor measures evenly, its stamps scatter."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.derived_kinds import DerivedKind
from recon4.model.import_notes import CLOUDS_EVENED
from recon4.model.trajectory import Times
from recon4.recording.clocks.tuning import EVEN_STAMPS
from recon4.recording.report import ImportReport


class EvenStamps:
    """Stamps of one topic or folder, and where they would lie if they followed each other evenly.

    A straight line fits the stamps around one. Where they scatter about it although all clouds
    begin as long after their stamp and last as long, the sensor measured evenly, and the stamps
    tell when a computer had time for it.
    """

    def __init__(self) -> None:
        self._stamps_ns: deque[int] = deque(maxlen=EVEN_STAMPS.most)
        self._points_ns: deque[tuple[int, int]] = deque(maxlen=EVEN_STAMPS.most)
        """First and last point after the stamp."""
        self._scatter_ns: list[float] = []

    def add(self, stamp_ns: int) -> None:
        """Take the stamp of the next message."""
        self._stamps_ns.append(stamp_ns)

    def each(self, stamps_ns: Times) -> Iterator[int]:
        """Stamps that are all known, one by one: before each those around it are added.

        Args:
            stamps_ns: In order [ns], (N,).
        """
        added, half = 0, EVEN_STAMPS.most // 2
        for row, stamp_ns in enumerate(stamps_ns.tolist()):
            self._stamps_ns.extend(stamps_ns[added : row + half].tolist())
            added = row + half
            yield stamp_ns

    def forget(self) -> None:
        """Begin again: the clock of the stamps was set."""
        self._stamps_ns.clear()

    def late_ns(self, stamp_ns: int, points_ns: Times) -> int:
        """How much later a stamp is than an even one [ns]; 0 = the stamps are right.

        Args:
            stamp_ns: One of those that were added; others are right.
            points_ns: Times of the points of its cloud, (N,).
        """
        self._points_ns.append((int(points_ns[0]) - stamp_ns, int(points_ns[-1]) - stamp_ns))
        if stamp_ns not in self._stamps_ns or len(self._points_ns) < EVEN_STAMPS.clouds:
            return 0
        # Times since 1970 would be rounded.
        since_ns = _without_gap([one - stamp_ns for one in self._stamps_ns])
        if len(since_ns) < EVEN_STAMPS.least:
            return 0
        period_ns = _period_ns(since_ns)
        if EVEN_STAMPS.most_of_period * period_ns < EVEN_STAMPS.right_ns:  # nothing is left between
            return 0
        before_next_ns = _before_next(since_ns, period_ns)
        even_ns = _line(since_ns, _numbers(before_next_ns, period_ns))
        scatter_ns, uneven_ns = _scatter(since_ns - even_ns), _scatter_of_points(self._points_ns)
        own = int(np.argmin(np.abs(since_ns)))
        right_ns = EVEN_STAMPS.right_ns * (EVEN_STAMPS.again if self._scatter_ns else 1.0)
        are_right = scatter_ns <= max(right_ns, EVEN_STAMPS.than_points * uneven_ns)
        off_ns = abs(float(before_next_ns[own] - even_ns[own]))
        are_uneven = max(scatter_ns, off_ns / 4.0) > EVEN_STAMPS.most_of_period * period_ns
        if are_right or are_uneven:
            return 0
        self._scatter_ns.append(scatter_ns)
        return round(float(since_ns[own] - even_ns[own]))

    def say(self, sensor: str, report: ImportReport) -> None:
        """Count and state what was evened; call once, at the end."""
        report.count(CLOUDS_EVENED, len(self._scatter_ns))
        if self._scatter_ns:
            scatter_ms = round(1e-6 * float(np.median(self._scatter_ns)), 1)
            report.derive(DerivedKind.STAMPS_EVENED, where=sensor, scatter_ms=scatter_ms)


def _without_gap(since_ns: Iterable[int]) -> Array:
    """Those times around 0, in order, that no gap separates from it: beyond, counting is unsure."""
    t_ns = np.sort(np.array(since_ns, np.float64))
    steps = np.diff(t_ns)
    if not len(steps):
        return t_ns
    part = np.concatenate([[0], np.cumsum(steps > EVEN_STAMPS.gap * np.median(steps))])
    return t_ns[part == part[np.argmin(np.abs(t_ns))]]


def _period_ns(t_ns: Array) -> float:
    """Usual time from one to the next, without those between which one is missing."""
    steps = np.diff(t_ns)
    return float(np.median(steps[steps <= 1.5 * np.median(steps)]))


def _before_next(t_ns: Array, period_ns: float) -> Array:
    """Times without what held one up for longer than those after it, which come soon then, (N,)."""
    before_ns = (1.0 - EVEN_STAMPS.most_of_period) * period_ns * np.arange(len(t_ns))
    earliest_ns = np.minimum.accumulate((t_ns - before_ns)[::-1])[::-1]
    return np.asarray(earliest_ns + before_ns, np.float64)


def _numbers(t_ns: Array, period_ns: float) -> Array:
    """Numbers of evenly measured clouds by their stamps, which missing ones have, too, (N,)."""
    numbers, even_ns = [0.0], float(t_ns[0])
    for stamp_ns in t_ns[1:].tolist():
        step = max(round((stamp_ns - even_ns) / period_ns), 1)
        numbers.append(numbers[-1] + step)
        even_ns += step * period_ns
        even_ns += EVEN_STAMPS.follows * (stamp_ns - even_ns)
    return np.array(numbers)


def _line(t_ns: Array, numbers: Array) -> Array:
    """Times on the straight line that fits most of them, (N,)."""
    off_ns = t_ns - np.polyval(np.polyfit(numbers, t_ns, 1), numbers)
    near = np.abs(off_ns - np.median(off_ns)) <= EVEN_STAMPS.near * max(_scatter(off_ns), 1.0)
    slope, start = np.polyfit(numbers[near], t_ns[near], 1)
    found: Array = start + slope * numbers
    return found


def _scatter_of_points(points_ns: Iterable[tuple[int, int]]) -> float:
    return max(_scatter(ends) for ends in zip(*points_ns, strict=True))


def _scatter(values: Iterable[float]) -> float:
    """Standard deviation by the median, which single values do not change."""
    x = np.array(values, np.float64)
    return 1.4826 * float(np.median(np.abs(x - np.median(x))))
