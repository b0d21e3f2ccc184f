"""Latency of the mapping, measured on the recorder's clock."""

from __future__ import annotations

from collections.abc import Callable

from recon4.live.mapper.tuning import LATENCY
from recon4.recording.report import ImportReport


class Latency:
    """Compares timestamps of points (possibly GPS time) with the recorder's clock."""

    def __init__(self, report: ImportReport, now_ns: Callable[[], int]) -> None:
        """Prepare.

        Args:
            report: Report of the reader, with the clock offset of each sensor to the recorder.
            now_ns: The recorder's clock [ns].
        """
        self._report, self._now_ns = report, now_ns
        self._left_out = 0
        """Multiframes left out since the last one that was mapped."""

    def on_recorder_clock(self, t_ns: int) -> int:
        """Convert a timestamp of points to the recorder's clock [ns]."""
        ahead_ns = sorted(self._report.ahead_ns.values())
        return t_ns - ahead_ns[len(ahead_ns) // 2] if ahead_ns else t_ns

    def age_s(self, t_ns: int) -> float:
        """Age of a time on the recorder's clock [s]."""
        return round((self._now_ns() - t_ns) / 1e9, 3)

    def leave_out(self, end_ns: int) -> bool:
        """Whether to leave a multiframe with this end time (sensor clock) out of the mapping.

        Leaves out one of n multiframes as `LATENCY.kept` says, more of them at a higher
        latency.
        """
        late_ns = self._now_ns() - self.on_recorder_clock(end_ns)
        one_of = max((n for limit_ns, n in LATENCY.kept if late_ns > limit_ns), default=1)
        leave_out = self._left_out + 1 < one_of
        self._left_out = self._left_out + 1 if leave_out else 0
        return leave_out
