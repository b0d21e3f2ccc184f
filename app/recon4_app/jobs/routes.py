"""HTTP routes of the jobs."""

from __future__ import annotations

import os
import secrets
import threading
from collections.abc import AsyncIterator, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Self

from fastapi import APIRouter, Depends, Query, Request
from fastapi.responses import FileResponse, PlainTextResponse
from fastapi.sse import EventSourceResponse, ServerSentEvent
from pydantic import BaseModel, ConfigDict, Field, model_validator
from starlette.concurrency import run_in_threadpool

from recon4.errors import NoSpace
from recon4.locales.coded import CodedText, coded
from recon4.model.rig import rig_presets
from recon4.settings import override, preset
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, needs
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import (
    PROJECTS,
    Conflict,
    NoRoom,
    NotFound,
    TooMany,
    project_page,
)
from recon4_app.jobs.model import Inputs, Job, JobKind, JobState
from recon4_app.jobs.space import refuse_if_full
from recon4_app.jobs.supervisor import now
from recon4_app.jobs.tuning import JOB_STREAM
from recon4_app.jobs.view import JobView, job_view
from recon4_app.names import Name
from recon4_app.network.rate_limit import at_most
from recon4_app.network.request_caller import CalledBy
from recon4_app.pages import Language, language_of
from recon4_app.rig_files import check_rig_file

router = APIRouter(
    prefix="/api",
    tags=["jobs"],
    dependencies=[Depends(needs(Permission.LOOK))],
    responses=problems(404, 409),
)
PROCESS = [Depends(needs(Permission.PROCESS))]
START = [*PROCESS, Depends(at_most(10, within_s=3600.0, what="jobs"))]
REFUSALS = problems(403, 429, 507)

_NOT_YET = ".not-yet"
"""Stands for the folder of a project whose name is not chosen yet."""
_NAMING = threading.Lock()
"""Held from the choice of a project's folder to its job: two requests get two folders."""


class NewJob(BaseModel):
    """A job to be started."""

    model_config = ConfigDict(extra="forbid")

    project: str = Field(default="", pattern=r"^([A-Za-z0-9][A-Za-z0-9._-]{0,63})?$")
    """Name of the project's folder; a new one is created, an existing project is run again.
    Empty = a new project, its folder is named after the title."""
    title: Name = Field(default="", max_length=100)
    """Display name of a new project; any letters."""
    recordings: list[str] = Field(min_length=1, max_length=16)
    """Files or folders of this computer."""
    preset: str = "indoor"
    """Preset of the settings: see `/api/choices`."""
    rig: str = ""
    """Name of a shipped rig or path of a rig file; empty = detected."""
    imu: str = ""
    """CSV file of this computer; empty = what the recording has."""
    gnss: str = ""
    """CSV file of this computer; empty = what the recording has."""
    settings: list[str] = Field(default=[], max_length=300)
    """``group.field=value`` texts over the preset."""
    clone_of: str = Field(default="", max_length=64)
    """A project whose finished stages the new one reuses, as far as their inputs match."""
    only_new: bool = False
    """Reject if a project of that name exists; otherwise it is run again."""

    @model_validator(mode="after")
    def _is_named(self) -> Self:
        if not self.project and not self.title.strip():
            raise ValueError(CodedText("project-or-title"))
        return self


class LogPiece(BaseModel):
    """A piece of a log from a byte offset on."""

    text: str
    next: int
    """Byte offset for the next request."""


@router.get("/jobs", summary="Newest jobs")
def list_jobs(server: Server, language: Language) -> list[JobView]:
    """List the newest job of each project."""
    return [job_view(server, job, language) for job in server.jobs.latest().values()]


@router.post(
    "/jobs", status_code=201, responses=REFUSALS, dependencies=START, summary="Start a job"
)
async def start_job(new: NewJob, server: Server, request: Request, *, caller: CalledBy) -> JobView:
    """Add a job to the queue.

    On an existing project, stages that do not depend on a changed input are reused. ``clone_of``
    does the same in a new project.
    """
    if new.rig and new.rig not in rig_presets():
        rig = await run_in_threadpool(server.projects.importable, new.rig)
        await check_rig_file(server.compute_pool, caller, rig)
    return await run_in_threadpool(add_job, new, server, request)


def add_job(new: NewJob, server: ServerParts, request: Request) -> JobView:
    """Add a job to the queue; a rig file must have been checked."""
    inputs = _checked(new, server)
    refuse_too_many(server)
    with _NAMING:
        project = new.project or server.projects.free_folder_name(
            new.title, server.jobs.has_project
        )
        server.projects.refuse_reserved(project)
        if new.only_new:
            server.projects.refuse_taken(project)
        if new.clone_of and new.clone_of != project:
            server.projects.clone(new.clone_of, project)
            if inputs.title:
                server.projects.rename(project, inputs.title)
        added = _add(server, project, inputs)
    audit(request, "start job", f"{project}: {', '.join(new.recordings)}")
    return job_view(server, added, language_of(request))


@router.get("/jobs/{job_id}", summary="One job")
def read_job(job_id: str, server: Server, language: Language) -> JobView:
    """Read a job and its progress."""
    return job_view(server, server.jobs.get(job_id), language)


@router.get("/projects/{project_id}/jobs", summary="Jobs of a project")
def jobs_of(project_id: str, server: Server, language: Language) -> list[JobView]:
    """List all jobs of a project with their inputs, the newest first."""
    return [job_view(server, job, language) for job in server.jobs.of_project(project_id)]


@router.post("/jobs/{job_id}/cancel", dependencies=PROCESS, summary="Cancel a job")
def cancel_job(job_id: str, server: Server, request: Request, *, language: Language) -> JobView:
    """Stop a job; its finished stages are kept."""
    job = server.supervisor.cancel(server.jobs.get(job_id))
    audit(request, "cancel job", job.project)
    return job_view(server, job, language)


@router.post(
    "/jobs/{job_id}/retry",
    status_code=201,
    responses=REFUSALS,
    dependencies=START,
    summary="Resume a job",
)
def retry_job(job_id: str, server: Server, request: Request) -> JobView:
    """Run the same again as a new job; it continues after the last finished stage."""
    job = server.jobs.get(job_id)
    if job.kind is not JobKind.PROCESS:
        raise Conflict(
            CodedText("order-not-resumed"),
            remedy=project_page(job.project),
        )
    _refuse_hidden(server, job.inputs)
    refuse_too_many(server)
    _refuse_if_full(server, job.project, job.inputs)
    added = _add(server, job.project, job.inputs)
    audit(request, "resume job", job.project)
    return job_view(server, added, language_of(request))


@router.post(
    "/projects/{project_id}/remake",
    status_code=201,
    responses=REFUSALS,
    dependencies=START,
    summary="Rebuild map",
)
def remake(project_id: str, server: Server, request: Request) -> JobView:
    """Apply the decisions about loop closures to the map: runs only the stages that depend on them.

    Neither the recording nor an earlier job of this server is needed.
    """
    server.projects.map_of_any_kind(project_id)  # raises if there is no map
    refuse_too_many(server)
    earlier = server.jobs.of_project(project_id)
    inputs = replace(earlier[0].inputs if earlier else Inputs(recordings=()), remake=True)
    _refuse_if_full(server, project_id, inputs)
    added = _add(server, project_id, inputs)
    audit(request, "rebuild map", project_id)
    return job_view(server, added, language_of(request))


@router.get("/jobs/{job_id}/log", response_class=PlainTextResponse, summary="Log")
def read_log(job_id: str, server: Server, lines: Annotated[int, Query(ge=1, le=5000)] = 200) -> str:
    """Read the last lines of a job's log."""
    return server.supervisor.folder(server.jobs.get(job_id).id).log_tail(lines=lines)


@router.get("/jobs/{job_id}/log/since", summary="New lines of a log")
def follow_log(
    job_id: str, server: Server, offset: Annotated[int, Query(ge=0, le=1 << 40)] = 0
) -> LogPiece:
    """Whole lines of a job's log from a byte offset on; continue with ``next``."""
    text, following = server.supervisor.folder(server.jobs.get(job_id).id).log_since(offset)
    return LogPiece(text=text, next=following)


@router.get("/jobs/{job_id}/log/file", response_class=FileResponse, summary="Download a log")
def download_log(job_id: str, server: Server) -> FileResponse:
    """Download the whole log."""
    job = server.jobs.get(job_id)
    path = server.supervisor.folder(job.id).path / "log.txt"
    if not path.exists():
        raise NotFound(CodedText("job-no-log"))
    return FileResponse(path, filename=f"{job.project}-log.txt", media_type="text/plain")


def _event_place(request: Request, server: Server) -> Iterator[None]:
    """A slot of the event streams (dependency), released when the stream ends."""
    with server.event_streams.place(request):
        yield


@router.get(
    "/events",
    response_class=EventSourceResponse,
    responses=problems(429),
    dependencies=[Depends(_event_place)],
    summary="Stream of job changes",
)
async def stream_jobs(server: Server, language: Language) -> AsyncIterator[ServerSentEvent]:
    """Server-sent events: a ``job`` with a `JobView` for each change of a job.

    The stream begins with one for each project's newest job, unless that succeeded. Those of files
    that are made of a map are events ``export``, those of comparisons ``compare``, those of
    searches for survey targets ``targets``.
    """
    version = server.supervisor.version
    jobs = [job for job in server.jobs.latest().values() if job.state is not JobState.SUCCEEDED]
    while not server.supervisor.news_ended:
        for job in jobs:
            event = "job" if job.kind is JobKind.PROCESS else str(job.kind)
            yield ServerSentEvent(event=event, data=job_view(server, job, language))
        await server.supervisor.news(version, timeout_s=JOB_STREAM.longest_quiet_s)
        touched = server.supervisor.touched_since(version)
        version = server.supervisor.version
        jobs = [server.jobs.get(job_id) for job_id in touched]


def _checked(new: NewJob, server: ServerParts) -> Inputs:
    """The inputs with resolved paths; settings are parsed now, to report mistakes at once."""
    override(preset(new.preset), new.settings)

    def resolved(path: str) -> str:
        return str(server.projects.importable(path)) if path else ""

    rig = new.rig if new.rig in rig_presets() else resolved(new.rig)
    inputs = Inputs(
        recordings=tuple(resolved(path) for path in new.recordings),
        preset=new.preset,
        rig=rig,
        imu=resolved(new.imu),
        gnss=resolved(new.gnss),
        settings=tuple(new.settings),
        title=new.title.strip(),
    )
    _refuse_if_full(server, new.project or _NOT_YET, inputs)
    return inputs


def _refuse_hidden(server: ServerParts, inputs: Inputs) -> None:
    """Check the files of an earlier job again: links may have changed, or the folders."""
    if inputs.remake:
        return
    rig = () if inputs.rig in rig_presets() else (inputs.rig,)
    for path in (*inputs.recordings, *rig, inputs.imu, inputs.gnss):
        if path and os.path.lexists(path):  # the job reports a missing file
            server.projects.importable(path)


def refuse_too_many(server: ServerParts) -> None:
    """Refuse a job if too many wait already.

    Raises:
        TooMany: If so.
    """
    waiting = len(server.jobs.in_state(JobState.QUEUED))
    if waiting >= server.settings.max_waiting_jobs:
        raise TooMany(
            CodedText("jobs-too-many", waiting=waiting),
            remedy=PROJECTS,
        )


def _refuse_if_full(server: ServerParts, project: str, inputs: Inputs) -> None:
    files = () if inputs.remake else (*inputs.recordings, inputs.imu, inputs.gnss)
    given = [Path(path) for path in files if path]
    try:
        refuse_if_full(
            server.settings.root / project,
            given,
            reserve_bytes=server.settings.free_disk_reserve_bytes,
        )
    except NoSpace as error:
        raise NoRoom(coded(error)) from error


def _add(server: ServerParts, project: str, inputs: Inputs) -> Job:
    job = Job(id=secrets.token_hex(8), project=project, inputs=inputs, created=now())
    server.jobs.add(job)
    server.supervisor.wake(job)
    return job
