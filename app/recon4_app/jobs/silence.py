"""Time without progress after which a worker counts as hung.

Stages that read files of users report every unit, so the server's setting applies to them as it is.
Later stages, and jobs that make something of a finished map, compute on our own artifacts: a solver
with a bounded number of iterations, or writing a large artifact, may report nothing for longer.
Time in which the worker was ready to run but other programs had the processors does not count: on a
busy computer a worker at low priority gets hardly any time, and to end it would not help.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

from recon4.store.stage import SAVING
from recon4.system.processes import waited_for_processor_s
from recon4_app.jobs.model import JobKind
from recon4_app.jobs.run_progress import AFTER
from recon4_app.jobs.status import JobStatus
from recon4_app.jobs.tuning import SILENCE

COMPUTING = frozenset({"graph", "verification", "review", "refine", "level", "map", AFTER, SAVING})
"""Stages, and pieces of work in any stage."""


def allowed_silence_s(kind: JobKind, status: JobStatus, hung_after_s: float) -> float:
    """Seconds without progress after which a worker at this point is killed."""
    running = {row.stage for row in status.stages if row.state == "running"}
    computes = kind is not JobKind.PROCESS or COMPUTING & {*running, status.what}
    return hung_after_s * (SILENCE.computing_factor if computes else 1.0)


@dataclass(slots=True)
class SilenceClock:
    """Measures how long one worker has made no progress."""

    _beat_ns: int | None = None
    _since_s: float = 0.0

    def silent_s(self, beat_ns: int, pid: int | None) -> float:
        """Seconds since the heartbeat last changed, without those waited for a processor.

        Args:
            beat_ns: Last heartbeat, on any clock [ns].
            pid: The worker; None = not known yet.
        """
        now_s = time.monotonic() - (waited_for_processor_s(pid) if pid else 0.0)
        if beat_ns != self._beat_ns:
            self._beat_ns, self._since_s = beat_ns, now_s
        return now_s - self._since_s
