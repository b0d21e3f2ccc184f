"""The queue on disk: SQLite, written only by the server process."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import msgspec
import sqlalchemy as sa
from sqlalchemy.exc import IntegrityError

from recon4.delivery.kinds import ExportedFile
from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.store.json_files import parse_object
from recon4.untrusted.names import visible
from recon4.untrusted.typed import as_type
from recon4_app.databases import migrate, open_engine
from recon4_app.errors import Conflict, NotFound, project_page
from recon4_app.jobs.model import Inputs, Job, JobKind, JobState
from recon4_app.jobs.reason import JobReason, reason_of
from recon4_app.state_copies import StateCopies

log = logging.getLogger(__name__)

METADATA = sa.MetaData()
JOBS = sa.Table(
    "jobs",
    METADATA,
    sa.Column("number", sa.Integer, primary_key=True),
    sa.Column("id", sa.String, unique=True, nullable=False),
    sa.Column("project", sa.String, nullable=False),
    sa.Column("inputs", sa.String, nullable=False),
    sa.Column("created", sa.String, nullable=False),
    sa.Column("state", sa.String, nullable=False),
    sa.Column("attempt", sa.Integer, nullable=False),
    sa.Column("started", sa.String, nullable=False),
    sa.Column("finished", sa.String, nullable=False),
    sa.Column("note", sa.String, nullable=False),
    sa.Column("kind", sa.String, nullable=False),
    sa.Column("person", sa.String, nullable=False),
    sa.Column("made", sa.String, nullable=False),
    sa.Column("reason", sa.String, nullable=False),
)
"""The table as the newest migration leaves it; ``number`` is the order of the queue. ``inputs``,
``made`` and ``reason`` are JSON that `_job` reads itself: in a list, SQLAlchemy's own type fails
over one damaged row."""

_PROCESSES = JOBS.c.kind == JobKind.PROCESS

ENDED = sa.Table("ended", METADATA, sa.Column("job", sa.String, primary_key=True))
"""Ids of jobs whose end was not announced yet."""


class JobStore:
    """All jobs, finished ones too."""

    def __init__(self, path: Path) -> None:
        self._copies = StateCopies(path)
        self.notice = _restore(self._copies)
        """Notice for users: set when the file was damaged, else empty."""
        self._engine = open_engine(path)
        self.on_ended: Callable[[], object] = lambda: None
        """Called after a job has ended, in any thread."""
        with self._engine.begin() as connection:
            migrate(connection, Path(__file__).parent)

    def close(self) -> None:
        """Close the database."""
        self._engine.dispose()

    def back_up(self) -> None:
        """Make today's backup, unless there is one."""
        self._copies.make()

    def add(self, job: Job) -> Job:
        """Append a job to the queue.

        Raises:
            Conflict: If it processes, and the project has a job that does so and waits or runs.
        """
        try:
            with self._engine.begin() as connection:
                connection.execute(JOBS.insert().values(**_row(job)))
        except IntegrityError as error:
            raise Conflict(
                CodedText("project-has-job-already", project=job.project),
                remedy=project_page(job.project),
            ) from error
        return job

    def change(self, before: Job, after: Job) -> Job:
        """Store the next state of a job.

        Raises:
            Conflict: If the job is no longer in the state of ``before``.
        """
        mine = (JOBS.c.id == before.id) & (JOBS.c.state == before.state)
        with self._engine.begin() as connection:
            if connection.execute(JOBS.update().where(mine).values(**_row(after))).rowcount != 1:
                raise Conflict(CodedText("job-changed", job=before.id, state=str(before.state)))
            if after.over and after.kind is JobKind.PROCESS:
                connection.execute(ENDED.insert().values(job=after.id))
        if after.over:
            self.on_ended()
        return after

    def ended(self) -> list[Job]:
        """Jobs whose end was not announced yet, oldest first."""
        mine = JOBS.select().where(JOBS.c.id.in_(sa.select(ENDED.c.job)))
        return self._select(mine.order_by(JOBS.c.number))

    def forget_ended(self, job_ids: Sequence[str]) -> None:
        """Note that the ends of these jobs were announced."""
        with self._engine.begin() as connection:
            connection.execute(ENDED.delete().where(ENDED.c.job.in_(job_ids)))

    def get(self, job_id: str) -> Job:
        """One job.

        Raises:
            NotFound: If there is no such job.
        """
        found = self._select(JOBS.select().where(JOBS.c.id == job_id))
        if not found:
            raise NotFound(CodedText("job-unknown", job=job_id))
        return found[0]

    def in_state(self, *states: JobState) -> list[Job]:
        """Jobs in any of the states, oldest first."""
        return self._select(JOBS.select().where(JOBS.c.state.in_(states)).order_by(JOBS.c.number))

    def counts(self) -> dict[JobState, int]:
        """Number of jobs in each state; states without jobs are left out."""
        query = sa.select(JOBS.c.state, sa.func.count()).group_by(JOBS.c.state)
        with self._engine.connect() as connection:
            return {JobState(state): count for state, count in connection.execute(query)}

    def latest(self) -> dict[str, Job]:
        """The newest job of each project; exports do not count."""
        newest = sa.select(sa.func.max(JOBS.c.number)).where(_PROCESSES).group_by(JOBS.c.project)
        jobs = self._select(JOBS.select().where(JOBS.c.number.in_(newest)))
        return {job.project: job for job in jobs}

    def of_project(self, project: str, kind: JobKind = JobKind.PROCESS) -> list[Job]:
        """Jobs of one kind of one project, newest first."""
        mine = JOBS.select().where((JOBS.c.project == project) & (JOBS.c.kind == kind))
        return self._select(mine.order_by(JOBS.c.number.desc()))

    def of_kind(self, kind: JobKind) -> list[Job]:
        """All jobs of one kind, newest first."""
        query = JOBS.select().where(JOBS.c.kind == kind)
        return self._select(query.order_by(JOBS.c.number.desc()))

    def is_used(self, project: str) -> bool:
        """Whether a job of any kind waits or runs on a project: it must stay where it is."""
        return any(not job.over for kind in JobKind for job in self.of_project(project, kind))

    def move_made(self, project: str, name: str) -> None:
        """List what was made of a project's map under another name: it follows into the trash."""
        mine = (JOBS.c.project == project) & (JOBS.c.kind != JobKind.PROCESS)
        with self._engine.begin() as connection:
            connection.execute(JOBS.update().where(mine).values(project=name))

    def has_project(self, project: str) -> bool:
        """Whether a job has a project, which may not exist yet."""
        return bool(self.of_project(project))

    def is_busy(self, project: str) -> bool:
        """Whether a job that changes a project waits or runs."""
        return any(not job.over for job in self.of_project(project))

    def _select(self, query: sa.Select[Any]) -> list[Job]:
        with self._engine.connect() as connection:
            return [_job(row) for row in connection.execute(query)]


def _restore(copies: StateCopies) -> str:
    """Replace a damaged queue; a notice about what was restored and lost, or empty."""
    restored = copies.restore()
    if restored is None:
        return ""
    code = "notice-jobs-restored" if restored.day else "notice-jobs-empty"
    notice = CodedText(code, damage=restored.damage, **restored.kept_as(), day=restored.day)
    log.error(notice)
    return notice


def _row(job: Job) -> dict[str, object]:
    row: dict[str, object] = {**asdict(job)}
    row |= {"inputs": json.dumps(row["inputs"]), "kind": job.kind}
    return row | {name: json.dumps(row[name]) if row[name] else "" for name in ("made", "reason")}


def _job(row: sa.Row[Any]) -> Job:
    """A row as a job; a damaged row is a failed job with a note."""
    try:
        return _whole_job(row)
    except (ValueError, KeyError, TypeError, StoreError, msgspec.ValidationError) as error:
        note = CodedText("job-row-damaged", detail=visible(repr(error)))
        return Job(
            id=visible(str(row.id)),
            project=visible(str(row.project)),
            inputs=Inputs(recordings=()),
            created=visible(str(row.created)),
            state=JobState.FAILED,
            note=str(note),
            reason=reason_of(note),
        )


def _whole_job(row: sa.Row[Any]) -> Job:
    inputs = as_type(parse_object(row.inputs, "inputs"), Inputs)
    made = as_type(parse_object(row.made, "made"), ExportedFile) if row.made else None
    reason = as_type(parse_object(row.reason, "reason"), JobReason) if row.reason else None
    ours = ("number", "inputs", "state", "kind", "made", "reason")
    fields = {name: value for name, value in row._asdict().items() if name not in ours}
    return Job(**fields, inputs=inputs, made=made, reason=reason, state=JobState(row.state))
