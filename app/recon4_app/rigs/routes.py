"""HTTP routes of the rigs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

from fastapi import APIRouter, Depends, Request
from fastapi.responses import FileResponse, HTMLResponse, PlainTextResponse, Response
from starlette.concurrency import run_in_threadpool

from recon4.locales.coded import CodedText, all_said, said
from recon4.model.lidars import LIDARS
from recon4.model.rig import SENSOR_MODELS, format_rig, load_rig, rig_presets
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, Who, needs
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import BadRequest
from recon4_app.network.request_caller import CalledBy, Caller
from recon4_app.pages import Language, page_response
from recon4_app.rigs import rig_work
from recon4_app.rigs.calibrations import evidence_of
from recon4_app.rigs.content import content_of, problems_of, rig_of, warnings_of
from recon4_app.rigs.model import (
    CalibratedVersion,
    CalibrationSlices,
    CalibrationView,
    FileBeside,
    NewRig,
    NewVersion,
    RigCard,
    RigCheck,
    RigContent,
    RigVersion,
    RigView,
    SavedRig,
    SensorModel,
)
from recon4_app.rigs.tuning import RIG_STORE
from recon4_app.tuning import RIG_FILE_TIMES

LOOK = [Depends(needs(Permission.LOOK))]
PROCESS = [Depends(needs(Permission.PROCESS))]

router = APIRouter(
    prefix="/api",
    tags=["rigs"],
    dependencies=LOOK,
    responses=problems(404, 409, 422),
)
page = APIRouter()


@page.get("/rigs/{rig_id}/", include_in_schema=False, dependencies=LOOK)
def rig_page(rig_id: str, request: Request, server: Server) -> HTMLResponse:
    if rig_id not in rig_presets():
        server.rigs.versions(rig_id)  # raises if there is no such rig
    return page_response("rigs/rigs.html", request)


@router.get("/rigs", summary="Rigs")
def list_rigs(server: Server) -> list[RigCard]:
    """List the rigs of this server, then those that come with recon4."""
    own = [_card(rig_id, server.rigs.versions(rig_id)[0]) for rig_id in server.rigs.ids()]
    return own + [_shipped_card(name) for name in rig_presets()]


@router.get("/sensor-models", summary="Models of sensors")
def list_models() -> list[SensorModel]:
    """List the models a rig may name, with the elevation of their lowest and highest beam."""
    return [SensorModel(model=name, elevation_deg=_elevation(name)) for name in SENSOR_MODELS]


@router.post("/rigs/check", summary="Check a rig")
def check_content(content: RigContent, language: Language) -> RigCheck:
    """List every problem of a rig; nothing is stored."""
    return RigCheck(
        problems=all_said(problems_of(content), language),
        warnings=[said(one, language) for one in warnings_of(content)],
    )


@router.get("/rigs/{rig_id}", summary="One rig")
async def read_rig(
    rig_id: str, server: Server, version: int | None = None, *, caller: CalledBy
) -> RigView:
    """Read a version of a rig, the newest by default, and which projects used the rig."""
    uses = await run_in_threadpool(server.rig_uses.of_rig, rig_id)
    if rig_id in rig_presets():
        content = await run_in_threadpool(_shipped_content, rig_id)
        return RigView(id=rig_id, shipped=True, version=0, content=content, versions=[], uses=uses)
    path = await run_in_threadpool(server.rigs.file, rig_id, version)
    versions = await run_in_threadpool(server.rigs.versions, rig_id)
    terms = Terms(
        person=caller.name, access=FileAccess(read=(path,)), limit_s=RIG_FILE_TIMES.limit_s
    )
    content = await caller.wait(
        server.compute_pool.run_interactive(Lane.INSPECT, terms, rig_work.read_content, path)
    )
    shown = versions[0].number if version is None else version
    return RigView(
        id=rig_id, shipped=False, version=shown, content=content, versions=versions, uses=uses
    )


@router.post("/rigs", status_code=201, dependencies=PROCESS, summary="Create a rig")
async def create_rig(new: NewRig, server: Server, *, caller: CalledBy, who: Who) -> SavedRig:
    """Create a rig from its content, a rig file, or another rig."""
    if sum((new.content is not None, new.toml is not None, bool(new.copy_of))) != 1:
        raise BadRequest(CodedText("rig-one-of-three"))
    if new.copy_of in rig_presets():
        text = format_rig(load_rig(new.copy_of))
        rig = await _checked_text(text, server, caller)
    elif new.copy_of:
        path = await run_in_threadpool(server.rigs.file, new.copy_of)
        rig = await _checked_file(server, caller, path)
    else:
        rig = await _checked_text(_text_of(new), server, caller, beside=new.beside)
    about = {"who": who.name, "note": new.note, "evidence": ""}
    saved = await run_in_threadpool(server.rigs.create, new.id, rig, **about)
    return _audited(caller.request, new.id, saved)


@router.post(
    "/rigs/{rig_id}/versions", status_code=201, dependencies=PROCESS, summary="Change a rig"
)
async def add_version(
    rig_id: str, new: NewVersion, server: Server, *, caller: CalledBy, who: Who
) -> SavedRig:
    """Store a new version of a rig; earlier versions stay as they are."""
    if (new.content is None) == (new.toml is None):
        raise BadRequest(CodedText("rig-one-of-two"))
    await run_in_threadpool(server.rigs.versions, rig_id)
    rig = await _checked_text(_text_of(new), server, caller, beside=new.beside)
    about = {"who": who.name, "note": new.note, "evidence": ""}
    saved = await run_in_threadpool(server.rigs.add, rig_id, rig, after=new.after, **about)
    return _audited(caller.request, rig_id, saved)


@router.get(
    "/rigs/{rig_id}/versions/{number}/file", response_class=FileResponse, summary="Export a rig"
)
def download_version(rig_id: str, number: int, server: Server) -> Response:
    """Download the rig file of a version; version 0 is a shipped rig."""
    if rig_id in rig_presets() and number == 0:
        head = {"Content-Disposition": f'attachment; filename="{rig_id}.toml"'}
        text = format_rig(load_rig(rig_id))
        return PlainTextResponse(text, media_type="application/toml", headers=head)
    path = server.rigs.file(rig_id, number)
    return FileResponse(path, filename=path.name, media_type="application/toml")


@router.get("/projects/{project_id}/calibration", summary="Audit of the rig")
def read_calibration(
    project_id: str, server: Server, *, language: Language
) -> CalibrationView | None:
    """What the recording says of its rig; null if the latest run had no audit."""
    return server.calibrations.of(project_id, language)


@router.get("/projects/{project_id}/calibration/slices", summary="Slices of a calibration")
def read_calibration_slices(project_id: str, server: Server) -> CalibrationSlices | None:
    """A slice through the walk by the rig file and by the calibrated rig; null if there is none."""
    return server.calibrations.slices(project_id)


@router.post(
    "/projects/{project_id}/calibration/rig",
    status_code=201,
    dependencies=PROCESS,
    summary="Save the calibrated rig",
)
async def save_calibrated(
    project_id: str, new: CalibratedVersion, server: Server, *, caller: CalledBy, who: Who
) -> SavedRig:
    """Store the calibrated rig of a project as a new version of a rig, with its evidence."""
    path = await run_in_threadpool(server.calibrations.file, project_id)
    view = await run_in_threadpool(server.calibrations.of, project_id)
    rig = await _checked_file(server, caller, path)
    evidence = evidence_of(view, project_id)[: RIG_STORE.max_evidence] if view else ""
    about = {"who": who.name, "note": new.note, "evidence": evidence}
    if new.create:
        saved = await run_in_threadpool(server.rigs.create, new.rig, rig, **about)
    else:
        saved = await run_in_threadpool(server.rigs.add, new.rig, rig, after=None, **about)
    return _audited(caller.request, new.rig, saved)


def _text_of(new: NewRig | NewVersion) -> str:
    """The text of a rig file: the given one, or that of the given content."""
    if new.content is not None:
        return format_rig(rig_of(new.content))
    return new.toml or ""


async def _checked_text(
    text: str, server: ServerParts, caller: Caller, *, beside: Sequence[FileBeside] = ()
) -> rig_work.CheckedRig:
    terms = Terms(person=caller.name, limit_s=RIG_FILE_TIMES.limit_s)
    pool = server.compute_pool
    return await caller.wait(
        pool.run_interactive(Lane.INSPECT, terms, rig_work.check_rig, text, beside)
    )


async def _checked_file(server: ServerParts, caller: Caller, path: Path) -> rig_work.CheckedRig:
    terms = Terms(
        person=caller.name, access=FileAccess(read=(path,)), limit_s=RIG_FILE_TIMES.limit_s
    )
    pool = server.compute_pool
    return await caller.wait(pool.run_interactive(Lane.INSPECT, terms, rig_work.check_rig_in, path))


def _audited(request: Request, rig_id: str, saved: RigVersion) -> SavedRig:
    audit(request, "save rig", f"{rig_id}, version {saved.number}")
    return SavedRig(id=rig_id, version=saved.number)


def _card(rig_id: str, newest: RigVersion) -> RigCard:
    return RigCard(
        id=rig_id,
        shipped=False,
        name=newest.name,
        sensors=newest.sensors,
        version=newest.number,
        when=newest.when,
        path=newest.path,
        problem=newest.problem,
    )


@cache
def _shipped_card(name: str) -> RigCard:
    rig = load_rig(name)
    sensors = [sensor.name for sensor in rig.sensors]
    return RigCard(
        id=name, shipped=True, name=rig.name, sensors=sensors, version=0, when="", path=name
    )


@cache
def _shipped_content(name: str) -> RigContent:
    return content_of(load_rig(name))


def _elevation(name: str) -> tuple[float, float] | None:
    facts = LIDARS[name]
    return facts.elevation_deg if facts.maker else None
