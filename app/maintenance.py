"""What has to be done now and then: sweep uploads and trash, copy the queue."""

from __future__ import annotations

import asyncio
import logging
import time

from app.jobs.store import JobStore
from app.projects.trash import Trash
from app.slices.store import Slices
from app.uploads.store import UploadStore

log = logging.getLogger(__name__)

EVERY_S = 3600.0


async def look_after(jobs: JobStore, uploads: UploadStore, trash: Trash, slices: Slices) -> None:
    """Do it at once and every hour, until cancelled; a failure is logged and tried again."""
    while True:
        for task in (
            jobs.back_up,
            lambda: uploads.sweep(time.time()),
            lambda: trash.sweep(time.time()),
            lambda: slices.exports.sweep(time.time()),
        ):
            try:
                await asyncio.to_thread(task)
            except Exception:
                log.exception("could not clean up or back up; trying again in an hour")
        await asyncio.sleep(EVERY_S)
