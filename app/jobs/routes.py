"""HTTP face of the jobs: parse, delegate, answer."""

from __future__ import annotations

import secrets
from collections.abc import AsyncIterator
from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, Query
from fastapi.responses import PlainTextResponse
from fastapi.sse import EventSourceResponse, ServerSentEvent
from pydantic import BaseModel, ConfigDict, Field

from app.deps import Parts, Server
from app.errors import Problem
from app.jobs.model import Inputs, Job
from app.jobs.status import Status
from app.jobs.supervisor import now
from recon4.model.rig import load_rig, rig_presets
from recon4.settings import PRESETS, override, preset

router = APIRouter(
    prefix="/api", tags=["jobs"], responses={404: {"model": Problem}, 409: {"model": Problem}}
)

LONGEST_QUIET_S = 15.0
"""An event stream says at least every so often that it is still there [s]."""


class NewJob(BaseModel):
    """What to process."""

    model_config = ConfigDict(extra="forbid")

    project: str = Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$")
    """Name of the project's folder; a new one is made, an old one is run again."""
    recordings: list[str] = Field(min_length=1, max_length=16)
    """Files or folders of this computer."""
    preset: str = "indoor"
    rig: str = ""
    """Name of a shipped rig or path of a rig file; empty = guessed."""
    imu: str = ""
    gnss: str = ""
    settings: list[str] = Field(default=[], max_length=100)
    """``group.field=value`` texts over the preset."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JobView:
    """A job and how far it is."""

    job: Job
    status: Status
    fraction: float | None
    """Share of the piece of work in hand, None = not known."""


class Choices(BaseModel):
    """What a new job may choose from."""

    presets: list[str]
    rigs: list[str]


@router.get("/choices")
def read_choices() -> Choices:
    """Presets and shipped rigs."""
    return Choices(presets=list(PRESETS), rigs=rig_presets())


@router.get("/jobs")
def list_jobs(server: Server) -> list[JobView]:
    """The newest job of each project."""
    return _views(server)


@router.post("/jobs", status_code=201, responses={403: {"model": Problem}})
def add_job(new: NewJob, server: Server) -> JobView:
    """Put a job in the queue."""
    return _add(server, new.project, _checked(new, server))


@router.get("/jobs/{job_id}")
def read_job(job_id: str, server: Server) -> JobView:
    """One job."""
    return _view(server, server.jobs.get(job_id))


@router.post("/jobs/{job_id}/cancel")
def cancel_job(job_id: str, server: Server) -> JobView:
    """Stop a job; its finished stages are kept."""
    return _view(server, server.supervisor.cancel(server.jobs.get(job_id)))


@router.post("/jobs/{job_id}/retry", status_code=201)
def retry_job(job_id: str, server: Server) -> JobView:
    """Run the same again as a new job; it goes on after the last finished stage."""
    job = server.jobs.get(job_id)
    return _add(server, job.project, job.inputs)


@router.get("/jobs/{job_id}/log", response_class=PlainTextResponse)
def read_log(job_id: str, server: Server, lines: Annotated[int, Query(ge=1, le=5000)] = 200) -> str:
    """The last lines of a job's log."""
    return server.supervisor.folder(server.jobs.get(job_id).id).log_tail(lines=lines)


@router.get("/events", response_class=EventSourceResponse)
async def stream_jobs(server: Server) -> AsyncIterator[ServerSentEvent]:
    """Server-sent events: ``job`` with a `JobView` at first for each job, then at each change."""
    sent: dict[str, JobView] = {}
    while True:
        version = server.supervisor.version
        fresh = {view.job.id: view for view in _views(server)}
        for job_id, view in fresh.items():
            if sent.get(job_id) != view:
                yield ServerSentEvent(event="job", data=view)
        sent = fresh
        await server.supervisor.news(version, timeout_s=LONGEST_QUIET_S)


def _checked(new: NewJob, server: Parts) -> Inputs:
    """The inputs with resolved paths; settings are parsed now so that mistakes show at once."""
    override(preset(new.preset), new.settings)

    def resolved(path: str) -> str:
        return str(server.projects.importable(path)) if path else ""

    rig = new.rig if new.rig in rig_presets() else resolved(new.rig)
    if rig:
        load_rig(rig)
    return Inputs(
        recordings=tuple(resolved(path) for path in new.recordings),
        preset=new.preset,
        rig=rig,
        imu=resolved(new.imu),
        gnss=resolved(new.gnss),
        settings=tuple(new.settings),
    )


def _add(server: Parts, project: str, inputs: Inputs) -> JobView:
    job = Job(id=secrets.token_hex(8), project=project, inputs=inputs, created=now())
    server.jobs.add(job)
    server.supervisor.wake()
    return _view(server, job)


def _views(server: Parts) -> list[JobView]:
    return [_view(server, job) for job in server.jobs.latest().values()]


def _view(server: Parts, job: Job) -> JobView:
    status = server.supervisor.status(job)
    return JobView(job=job, status=status, fraction=status.fraction)
