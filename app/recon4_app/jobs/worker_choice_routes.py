"""HTTP routes of the workers that make parts of jobs: for administrators."""

from __future__ import annotations

import subprocess
import sys
import threading
from dataclasses import dataclass

import msgspec
from fastapi import APIRouter, Depends, Request
from pydantic import Field

from recon4.errors import ConfigError
from recon4.executors.chosen import (
    CERTIFICATES,
    ChosenWorkers,
    certificates_in,
    checked_choice,
    read_choice,
    store_choice,
)
from recon4.locales.coded import CodedText
from recon4.untrusted.typed import decoded
from recon4_app.access.audit import audit
from recon4_app.access.login.routes import Text, Wire
from recon4_app.access.people import Permission, needs, recent_login
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import Conflict
from recon4_app.jobs.tuning import ORDERING
from recon4_app.settings import worker_environment

router = APIRouter(
    prefix="/api/workers",
    tags=["administration"],
    dependencies=[Depends(needs(Permission.ADMINISTER))],
    responses=problems(403, 409, 422),
)
RECENT_LOGIN = Depends(recent_login)
_TESTING = threading.Lock()
"""Held while the workers are tested: one test at a time."""


class WorkerChoice(Wire):
    """The workers that make parts of jobs from now on."""

    count: int = Field(default=0, ge=0)
    """Processes of this computer; 0 = none."""
    scheduler: Text = ""
    """Address of a scheduler of Dask, ``tls://HOST:PORT``; empty = none."""
    dashboard: Text = ""
    """Address of its dashboard; empty = none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkerChoiceView:
    """The workers that make parts of jobs."""

    count: int
    """Processes of this computer; 0 = none."""
    scheduler: str
    """Address of a scheduler of Dask; empty = none."""
    dashboard: str
    """Address of its dashboard; empty = none."""
    folder: str
    """Folder of this computer in which the certificates of a scheduler have to lie."""
    has_certificates: bool
    """Whether they do."""


class WorkerTest(msgspec.Struct, frozen=True, kw_only=True):
    """A line of ``recon4 doctor --json``."""

    what: str
    found: str
    ok: bool
    advice: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkerTestView:
    """What a test of the workers found."""

    ok: bool
    text: str
    """What was found, or what is wrong; in English."""


@router.get("", summary="Workers of jobs")
def read_workers(server: Server) -> WorkerChoiceView:
    """Read which workers make parts of jobs."""
    return _view(server)


@router.put("", dependencies=[RECENT_LOGIN], summary="Choose workers of jobs")
def choose_workers(new: WorkerChoice, request: Request, server: Server) -> WorkerChoiceView:
    """Choose who makes parts of the jobs that begin from now on."""
    chosen = checked_choice(ChosenWorkers(**new.model_dump()))
    store_choice(server.settings.state, chosen)
    audit(request, "choose workers", chosen.scheduler or str(chosen.count))
    return _view(server)


@router.post("/test", summary="Test the workers")
def test_workers(server: Server) -> WorkerTestView:
    """Ask the chosen workers for their versions, and whether they see the folder of the projects.

    ``recon4 doctor`` does it, in a process of its own.
    """
    if not _TESTING.acquire(blocking=False):
        raise Conflict(CodedText("workers-being-tested"))
    try:
        return _tested(server)
    finally:
        _TESTING.release()


def _tested(server: ServerParts) -> WorkerTestView:
    command = [sys.executable, "-P", "-m", "recon4", "doctor", str(server.settings.root), "--json"]
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=worker_environment(),
            timeout=ORDERING.tested_within_s,
            check=False,
        )
        lines = decoded(done.stdout, list[WorkerTest])
    except (subprocess.TimeoutExpired, msgspec.DecodeError) as error:
        raise ConfigError(CodedText("workers-test-failed")) from error
    (line,) = [one for one in lines if one.what == "workers of jobs"]
    return WorkerTestView(ok=line.ok, text=": ".join(filter(None, (line.found, line.advice))))


def _view(server: ServerParts) -> WorkerChoiceView:
    chosen = read_choice(server.settings.state)
    folder = server.settings.state / CERTIFICATES
    files = certificates_in(folder)
    return WorkerChoiceView(
        count=chosen.count,
        scheduler=chosen.scheduler,
        dashboard=chosen.dashboard,
        folder=str(folder),
        has_certificates=all(
            path.is_file() for path in (files.authority, files.certificate, files.key)
        ),
    )
