"""The files that exports and comparisons have made, in the folders of their jobs."""

from __future__ import annotations

import shutil
from datetime import datetime
from pathlib import Path

from recon4_app.exports.tuning import KEPT_EXPORTS
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.model import Job, JobKind, JobState
from recon4_app.jobs.store import JobStore


class KeptExports:
    """Finds files that were made of maps, and removes old ones; their rows stay in the list."""

    def __init__(self, jobs: JobStore, state: Path) -> None:
        self._jobs, self._folder = jobs, state / "jobs"

    def path(self, job: Job) -> Path | None:
        """The file of an export; None = there is none, or it is not the one that was listed."""
        if job.made is None or job.state is not JobState.SUCCEEDED:
            return None
        folder = JobFolder(self._folder / job.id).made
        path = folder / Path(job.made.name).name  # a worker that a file took over may name any
        try:
            found = path.lstat()
        except OSError:
            return None
        whole = path.is_file() and not path.is_symlink() and found.st_size == job.made.bytes
        return path if whole else None

    def remove(self, job: Job) -> None:
        """Remove the file of an export."""
        shutil.rmtree(JobFolder(self._folder / job.id).made, ignore_errors=True)

    def sweep(self, now_s: float) -> int:
        """Remove files of exports that are too old, or the oldest if all are too large.

        Returns:
            How many were removed.
        """
        total, removed = 0, 0
        for job in self._made():
            if not job.over or not JobFolder(self._folder / job.id).made.exists():
                continue
            total += job.made.bytes if job.made else 0
            too_old = now_s - _finished_s(job) > KEPT_EXPORTS.kept_s
            if job.made is None or too_old or total > KEPT_EXPORTS.max_bytes:
                self.remove(job)
                removed += 1
        return removed

    def _made(self) -> list[Job]:
        """What was made of maps, newest first."""
        kinds = JobKind.EXPORT, JobKind.COMPARE, JobKind.TARGETS
        made = [job for kind in kinds for job in self._jobs.of_kind(kind)]
        return sorted(made, key=lambda job: job.created, reverse=True)


def _finished_s(job: Job) -> float:
    try:
        return datetime.fromisoformat(job.finished).timestamp()
    except ValueError:  # a damaged row
        return 0.0
