"""Recent findings and repairs of the reader of a capture."""

from __future__ import annotations

from collections import deque

from recon4.live.mapper.tuning import NOTES
from recon4.live.protocol import Notes
from recon4.model.finding_kinds import CLOCK_DOUBTS
from recon4.recording.report import ImportReport


class NotesWatch:
    """Follows an import report that grows."""

    def __init__(self, report: ImportReport) -> None:
        self._report = report
        self._seen_s: list[float] = []
        self._counts: deque[tuple[float, dict[str, int]]] = deque()
        """Time and counts of recent messages; before the first one nothing was counted."""

    def message(self, now_s: float) -> Notes:
        """Build the message ``notes`` of ``docs/how-to/live.md``.

        Args:
            now_s: A monotonic time [s].
        """
        found = self._report.findings
        self._seen_s += [now_s] * (len(found) - len(self._seen_s))
        current = [
            one
            for one, seen_s in zip(found, self._seen_s, strict=False)
            if now_s - seen_s < NOTES.fresh_s or one.kind in CLOCK_DOUBTS
        ]
        counts = dict(self._report.counts)
        if not self._counts:
            self._counts.append((now_s, {}))
        self._counts.append((now_s, counts))
        while now_s - self._counts[0][0] > NOTES.recent_s:
            self._counts.popleft()
        before = self._counts[0][1]
        recent = {name: count - before.get(name, 0) for name, count in counts.items()}
        recent = {name: count for name, count in recent.items() if count}
        return Notes(findings=current[-NOTES.most :], counts=counts, recent=recent)
