"""Time without progress after which a worker counts as hung.

Stages that read files of users report every unit, so the server's setting applies to them as it is.
Later stages compute on our own artifacts: a solver with a bounded number of iterations, or writing
a large artifact, may report nothing for longer.
"""

from __future__ import annotations

from app.jobs.run_progress import AFTER
from app.jobs.status import JobStatus
from recon4.store.stage import SAVING

COMPUTING_FACTOR = 10.0
COMPUTING = frozenset({"graph", "verification", "review", "refine", "level", "map", AFTER, SAVING})
"""Stages, and pieces of work in any stage."""


def allowed_silence_s(status: JobStatus, hung_after_s: float) -> float:
    """Seconds without progress after which a worker at this point is killed."""
    running = {row.stage for row in status.stages if row.state == "running"}
    return hung_after_s * (COMPUTING_FACTOR if COMPUTING & {*running, status.what} else 1.0)
