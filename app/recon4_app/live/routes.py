"""HTTP routes of live capture."""

from __future__ import annotations

from pathlib import Path
from typing import Literal, Self

from fastapi import APIRouter, Depends, WebSocket, WebSocketDisconnect
from pydantic import BaseModel, ConfigDict, Field, model_validator
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request

from recon4.live.findings import CaptureFinding
from recon4.live.protocol import AddMark, Pause, Resume
from recon4.locales.coded import CodedText
from recon4.model.rig import load_rig, parse_rig
from recon4.settings import PRESET_TEXTS, PRESETS
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, Who, needs
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.deps import Server, parts
from recon4_app.error_responses import problems
from recon4_app.errors import Conflict, TooMany
from recon4_app.jobs.routes import NewJob, add_job
from recon4_app.jobs.view import JobView
from recon4_app.live.current_capture import CurrentCapture
from recon4_app.live.phone import Phone, state_of
from recon4_app.live.rigs import RigChoice, rig_files, rigs_in, shipped_rigs
from recon4_app.names import Name, Note
from recon4_app.network.close_codes import CloseCode, close_reason
from recon4_app.network.request_caller import CalledBy
from recon4_app.pages import language_of
from recon4_app.rig_files import read_rig_file

LOOK = [Depends(needs(Permission.LOOK))]
CAPTURE = [Depends(needs(Permission.CAPTURE))]

router = APIRouter(
    prefix="/api/live",
    tags=["live capture"],
    responses=problems(404, 409),
)


class NewCapture(BaseModel):
    """Parameters of a new capture."""

    model_config = ConfigDict(extra="forbid")

    project: str = Field(default="", pattern=r"^([A-Za-z0-9][A-Za-z0-9._-]{0,63})?$")
    """Name of the new project's folder; empty = named after the place."""
    rig: str = "4recon"
    """Name of a shipped rig or path of a rig file on the server."""
    preset: str = "indoor"
    place: Name = Field(default="", max_length=200)
    """Name of the place: display name of the project; any letters."""

    @model_validator(mode="after")
    def _is_named(self) -> Self:
        if not self.project and not self.place.strip():
            raise ValueError(CodedText("capture-needs-name"))
        return self


class NewMark(BaseModel):
    """A mark of the operator."""

    model_config = ConfigDict(extra="forbid")

    what: Literal["point", "place"] = "point"
    text: Note = Field(default="", max_length=500)
    ago_s: float = Field(default=0.0, ge=0.0, le=3600.0)
    """Age of the mark [s]: the operator walks on while typing the note, or had no link."""


class CaptureChoices(BaseModel):
    """Presets and rigs for a capture."""

    presets: list[str]
    preset_texts: dict[str, str]
    """Preset -> what it is for, in a line."""
    rigs: list[RigChoice]


class CaptureView(BaseModel):
    """State of a capture."""

    project: str
    state: str
    """``recording``, ``paused``, ``finishing`` or ``ready`` (to be processed)."""
    findings: list[CaptureFinding]
    """Warnings, the most urgent first: level (``error``, ``warning``, ``info``) and text."""
    rates: dict[str, float]
    """Datagrams per second of each LiDAR, the IMU and the GNSS receiver."""
    phones: int
    may_capture: bool
    """Whether the caller may control it."""


@router.get("", dependencies=LOOK, summary="State of the capture")
def read_capture(server: Server, who: Who) -> CaptureView | None:
    """The running or the last capture; null if there was none since the server started."""
    if server.current_capture.newest is None:
        return None
    return _view(server.current_capture, who.may(Permission.CAPTURE))


@router.get("/choices", dependencies=LOOK, summary="Rigs and presets")
async def read_choices(server: Server, caller: CalledBy) -> CaptureChoices:
    """Rig files in the folder of the projects or the import folders; shipped rigs."""
    files = await run_in_threadpool(
        rig_files, server.settings.import_roots, server.projects.imports.shows
    )
    own: list[RigChoice] = []
    if files:
        terms = Terms(person=caller.name, access=FileAccess(read=files))
        pool = server.compute_pool
        own = await caller.wait(pool.run_interactive(Lane.INSPECT, terms, rigs_in, files))
    return CaptureChoices(
        presets=list(PRESETS), preset_texts=PRESET_TEXTS, rigs=own + shipped_rigs()
    )


@router.post("", status_code=201, dependencies=CAPTURE, summary="Start a capture")
async def start_capture(
    new: NewCapture, server: Server, who: Who, *, caller: CalledBy
) -> CaptureView:
    """Open the sensors' ports and record; the project exists from the start."""
    if Path(new.rig).suffix:
        file = await run_in_threadpool(server.projects.importable, new.rig)
        text = await read_rig_file(server.compute_pool, caller, file)
        rig = parse_rig(text, where=file.name)
    else:
        rig = load_rig(new.rig)
    if new.project:
        await run_in_threadpool(server.projects.refuse_taken, new.project)
    project = new.project or await run_in_threadpool(
        server.projects.free_folder_name, new.place, server.jobs.has_project
    )
    capture = await server.current_capture.start(
        project, rig, preset=new.preset, address=server.settings.sensor_bind_address
    )
    if new.place:
        await capture.request(AddMark("place", new.place, who.name))
        await run_in_threadpool(server.projects.rename, project, new.place)
    audit(caller.request, "live.start", project)
    return _view(server.current_capture, may_capture=True)


@router.post("/stop", dependencies=CAPTURE, summary="Stop recording")
async def stop_capture(request: Request, server: Server) -> CaptureView:
    """Stop; the project is ready soon after."""
    capture = await server.current_capture.stop()
    audit(request, "live.stop", capture.project)
    return _view(server.current_capture, may_capture=True)


@router.post("/pause", dependencies=CAPTURE, summary="Pause recording")
async def pause_capture(server: Server) -> CaptureView:
    """Datagrams until `resume` are counted but not recorded."""
    await server.current_capture.capture().request(Pause())
    return _view(server.current_capture, may_capture=True)


@router.post("/resume", dependencies=CAPTURE, summary="Resume recording")
async def resume_capture(server: Server) -> CaptureView:
    """End a pause. The operator should stand where the pause began."""
    await server.current_capture.capture().request(Resume())
    return _view(server.current_capture, may_capture=True)


@router.post(
    "/process",
    status_code=201,
    dependencies=[Depends(needs(Permission.PROCESS))],
    summary="Make the map of a capture that has ended",
)
def process_capture(request: Request, server: Server) -> JobView:
    """Start a processing job on the project; its frames are done already."""
    session = server.current_capture.capture().session
    if not server.current_capture.capture().over:
        raise Conflict(CodedText("capture-still-running"))
    new = NewJob(
        project=session.project.name,
        recordings=[str(session.capture)],
        preset=session.preset,
        rig=str(session.rig),
    )
    return add_job(new, server, request)


@router.post("/marks", status_code=201, dependencies=CAPTURE, summary="Mark a point of interest")
async def add_mark(mark: NewMark, server: Server, who: Who) -> dict[str, str]:
    """Save a mark; it is on the disk before it appears in the stream. A place names the project."""
    capture = server.current_capture.capture()
    await capture.request(AddMark(mark.what, mark.text, who.name, mark.ago_s))
    if mark.what == "place" and mark.text:
        await run_in_threadpool(server.projects.rename, capture.project, _one_line(mark.text))
    return {"status": "noted"}


def _one_line(text: str) -> str:
    return " ".join(text.split())[:200]


@router.websocket("/stream", dependencies=LOOK)
async def stream(socket: WebSocket) -> None:
    """Stream the part of the map and state this phone lacks (``docs/how-to/live.md``)."""
    current_capture = parts(socket).current_capture
    await socket.accept()  # a page receives the close code and reason of an accepted socket only
    try:
        with current_capture.streams.place(socket):
            await Phone(socket, current_capture, language_of(socket)).serve()
    except TooMany as error:
        await socket.close(CloseCode.TOO_MANY, close_reason(error, socket))
    except (WebSocketDisconnect, TimeoutError, RuntimeError):
        pass  # disconnected or stalled: it reconnects and reports what it has


def _view(current_capture: CurrentCapture, may_capture: bool) -> CaptureView:
    capture = current_capture.capture()
    state = state_of(current_capture, capture)
    return CaptureView(
        project=capture.project,
        state=capture.state,
        findings=state.findings,
        rates=state.rates,
        phones=current_capture.streams.open,
        may_capture=may_capture,
    )
