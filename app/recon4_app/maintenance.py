"""Periodic maintenance: tasks of every hour, rotation of logs."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from recon4_app.jobs.model import JobState
from recon4_app.jobs.store import JobStore
from recon4_app.live.current_capture import CurrentCapture
from recon4_app.logs import rotate_grown
from recon4_app.threads import in_thread
from recon4_app.tuning import MAINTENANCE

log = logging.getLogger(__name__)


async def maintain(tasks: Sequence[Callable[[], object]]) -> None:
    """Run the tasks every hour, until cancelled; a failure is logged and retried."""
    while True:
        for task in tasks:
            try:
                await in_thread(task)
            except Exception:
                log.exception("could not clean up or back up; trying again in an hour")
        await asyncio.sleep(MAINTENANCE.maintenance_interval_s)


async def rotate_logs(state: Path, jobs: JobStore, current_capture: CurrentCapture) -> None:
    """Rotate the logs that other processes append to, until cancelled."""
    while True:
        try:
            paths = await in_thread(lambda: list(active_logs(state, jobs, current_capture)))
            for path in paths:
                await in_thread(rotate_grown, path)
        except Exception:
            log.exception("could not rotate the logs; trying again")
        await asyncio.sleep(MAINTENANCE.log_rotation_interval_s)


def active_logs(state: Path, jobs: JobStore, current_capture: CurrentCapture) -> Iterator[Path]:
    """Logs of the processes that may be running.

    Args:
        state: The server's own folder.
        jobs: Its queue.
        current_capture: Its live capture.
    """
    yield from (state / "viewers").glob("*.txt")
    for job in jobs.in_state(JobState.RUNNING):
        yield state / "jobs" / job.id / "log.txt"
    if current_capture.newest is not None:
        yield from current_capture.newest.session.folder.glob("*.txt")
