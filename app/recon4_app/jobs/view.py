"""A job as the pages show it."""

from __future__ import annotations

from dataclasses import dataclass

from recon4_app.deps import ServerParts
from recon4_app.errors import STORAGE, RemedyLink
from recon4_app.jobs.folder import JobWorkers, Outcome
from recon4_app.jobs.model import Job, JobKind, JobState
from recon4_app.jobs.status import JobStatus


@dataclass(frozen=True, slots=True, kw_only=True)
class JobView:
    """A job and its progress."""

    job: Job
    status: JobStatus
    fraction: float | None
    """Fraction of the current piece of work, None = not known."""
    run_progress: float
    """Fraction of the whole run."""
    run_eta_s: float | None
    """Remaining time of the whole run [s], None = not known yet."""
    resumable: bool
    """Whether it ended early and can be run again."""
    workers: JobWorkers
    """Who makes parts of it on other processes or computers."""
    remedy: RemedyLink | None
    """The page where what the note of a failed job advises is done, if it is another one."""


def job_view(server: ServerParts, job: Job, language: str) -> JobView:
    """A job and its progress, in a language."""
    status, run = server.supervisor.status(job), server.supervisor.run_progress(job)
    failed = job.state is JobState.FAILED
    folder = server.supervisor.folder(job.id)
    outcome = folder.outcome() if failed else None
    return JobView(
        job=job.said(language),
        status=status,
        fraction=status.fraction,
        run_progress=run.fraction,
        run_eta_s=run.eta_s,
        workers=JobWorkers() if job.state is JobState.QUEUED else folder.workers(),
        resumable=_is_resumable(job, outcome),
        remedy=STORAGE.link(language) if outcome is not None and outcome.no_space else None,
    )


def _is_resumable(job: Job, outcome: Outcome | None) -> bool:
    if job.kind is not JobKind.PROCESS:
        return False
    if job.state is not JobState.FAILED:
        return job.state is JobState.CANCELLED
    return outcome is None or outcome.startable
