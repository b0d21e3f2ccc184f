"""How far the mapping is behind, told on the recorder's clock."""

from __future__ import annotations

from collections.abc import Callable

from recon4.recording.report import ImportReport

LATE_NS = 700_000_000
"""A multiframe older than that when its turn comes may be left out of the mapping [ns]."""
_KEPT = ((LATE_NS, 2), (2_000_000_000, 3), (5_000_000_000, 5))
"""Older than so much: one of so many is mapped."""


class Latency:
    """Compares the times of the points, which GPS may drive, with a clock that may be wrong."""

    def __init__(self, report: ImportReport, now_ns: Callable[[], int]) -> None:
        """Prepare.

        Args:
            report: Of the reader; it knows how far the sensors are ahead of the recorder.
            now_ns: The recorder's clock [ns].
        """
        self._report, self._now_ns = report, now_ns
        self._left_out = 0
        """Since the last one that was mapped."""

    def on_our_clock(self, t_ns: int) -> int:
        """A time of points, by the clock of the recorder [ns]."""
        ahead_ns = sorted(self._report.ahead_ns.values())
        return t_ns - ahead_ns[len(ahead_ns) // 2] if ahead_ns else t_ns

    def age_s(self, t_ns: int) -> float:
        """How long ago that was [s]; the time is of the recorder's clock."""
        return round((self._now_ns() - t_ns) / 1e9, 3)

    def leave_out(self, end_ns: int) -> bool:
        """Whether to leave out of the mapping a multiframe that ended then by its own clock:
        every other one while behind, more of them when far behind.
        """
        late_ns = self._now_ns() - self.on_our_clock(end_ns)
        one_of = max((many for limit_ns, many in _KEPT if late_ns > limit_ns), default=1)
        leave_out = self._left_out + 1 < one_of
        self._left_out = self._left_out + 1 if leave_out else 0
        return leave_out
