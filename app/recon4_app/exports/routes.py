"""HTTP routes of exports: files of a map as jobs, and the list of them."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from fastapi import APIRouter, Depends, Request
from fastapi.encoders import jsonable_encoder
from fastapi.responses import FileResponse, JSONResponse
from pydantic import TypeAdapter, ValidationError
from starlette.concurrency import run_in_threadpool

from recon4.delivery.kinds import ExportEstimate, title_of
from recon4.errors import StoreError
from recon4.export.options import ExportOptions
from recon4.locales.coded import CodedText, at
from recon4.store.json_files import read_object
from recon4.untrusted.limits import LIMITS
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, needs
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import STORAGE, Conflict, NoRoom, NotFound
from recon4_app.exports import export_work
from recon4_app.exports.deliveries import checked, order_of
from recon4_app.exports.equal_orders import equal_order
from recon4_app.exports.model import DeliveryCheck, ExportChoices, ExportView, NewExport
from recon4_app.exports.tuning import KEPT_EXPORTS
from recon4_app.jobs.model import ExportOrder, Inputs, Job, JobKind
from recon4_app.jobs.orders import add_order, find_order, latest_map_key, refuse_others
from recon4_app.jobs.routes import refuse_too_many
from recon4_app.network.rate_limit import at_most
from recon4_app.network.request_caller import CalledBy, Caller
from recon4_app.pages import Language, language_of

router = APIRouter(
    prefix="/api/projects/{project_id}/exports",
    tags=["exports"],
    dependencies=[Depends(needs(Permission.LOOK))],
    responses=problems(404, 422),
)
ORDER = [Depends(at_most(60, within_s=3600.0, what="exports"))]
REFUSALS = problems(403, 429, 507)


@router.get("", summary="Exports of a project")
def list_exports(project_id: str, server: Server, *, language: Language) -> list[ExportView]:
    """List what was exported, by whom and when, with hashes; the newest first.

    A row stays when its file is removed after a week.
    """
    server.projects.folder(project_id)
    jobs = server.jobs.of_project(project_id, JobKind.EXPORT)[: KEPT_EXPORTS.listed]
    map_key = latest_map_key(server, project_id)
    return [_view(server, job, map_key, language=language) for job in jobs]


@router.get("/choices", summary="What can be exported")
async def read_choices(project_id: str, *, server: Server, caller: CalledBy) -> ExportChoices:
    """Kinds of files with the options that each takes, classes, and the storeys of the map."""
    slices = server.slices
    artifacts = await run_in_threadpool(slices.artifacts, project_id)
    evidence = await run_in_threadpool(slices.evidence_to_show, project_id)
    terms = slices.terms(project_id, caller.name)
    out = "choices.json"

    async def make(path: Path) -> None:
        made = replace(terms, outputs={out: path})
        work: Callable[..., None] = export_work.write_choices
        await slices.run_interactive(made, work, artifacts, out, evidence=evidence)

    name = f"{Path(artifacts['map']).name}-{Path(artifacts.get('level', '')).name[:16]}-exports-2"
    path = await caller.wait(slices.kept(f"{name}.json", make))
    return await run_in_threadpool(_read_choices, path)


@router.post("/estimate", summary="Size of an export")
async def estimate(
    project_id: str, new: NewExport, *, server: Server, caller: CalledBy
) -> ExportEstimate:
    """Say about how many points and bytes a file will have; what cannot be made is refused."""
    wanted = await _wanted(project_id, new, server=server, caller=caller)
    return await _estimate(project_id, wanted, server=server, caller=caller)


@router.post(
    "",
    status_code=201,
    response_model=ExportView,
    dependencies=ORDER,
    responses=REFUSALS | {200: {"model": ExportView, "description": "It was ordered before."}},
    summary="Make a file of the map",
)
async def order(
    project_id: str, new: NewExport, *, server: Server, request: Request, caller: CalledBy
) -> ExportView | JSONResponse:
    """Add an export to the queue; it runs beside jobs that process.

    If the same one of this map waits, runs or is kept, that one is returned, with status 200.
    A delivery, and a file with notes, is made again: people may have added to them.
    """
    wanted = await _wanted(project_id, new, server=server, caller=caller)
    if same := await run_in_threadpool(equal_order, server, project_id, wanted):
        map_key = latest_map_key(server, project_id)
        row = _view(server, same, map_key, language=language_of(request))
        return JSONResponse(jsonable_encoder(row))
    found = await _estimate(project_id, wanted, server=server, caller=caller)
    add = partial(_add, project_id, wanted, server, request=request, expected=found)
    return await run_in_threadpool(add)


@router.post("/{export_id}/cancel", responses=REFUSALS, summary="Cancel an export")
def cancel(project_id: str, export_id: str, *, server: Server, request: Request) -> ExportView:
    """Stop an export; nothing of the file is left."""
    job = _export(server, project_id, export_id)
    refuse_others(request, job)
    job = server.supervisor.cancel(job)
    audit(request, "cancel export", f"{project_id}: {_file_of(job)}")
    return _view(server, job, latest_map_key(server, project_id), language=language_of(request))


@router.get("/{export_id}/file", response_class=FileResponse, summary="Download an export")
def download(project_id: str, export_id: str, server: Server) -> FileResponse:
    """Download a file that was made; ``Range`` with ``If-Range`` continues a download.

    The entity tag is its SHA-256.
    """
    job = _export(server, project_id, export_id)
    path = server.exports.path(job)
    if path is None or job.made is None:
        raise NotFound(CodedText("export-gone"))
    return FileResponse(
        path,
        filename=path.name,
        media_type="application/octet-stream",
        headers={"ETag": f'"{job.made.sha256}"'},
    )


@router.get(
    "/{export_id}/check",
    responses=problems(429),
    dependencies=[Depends(at_most(60, within_s=3600.0, what="verifications"))],
    summary="Verify a delivery",
)
async def check(
    project_id: str, export_id: str, *, server: Server, caller: CalledBy
) -> DeliveryCheck:
    """Read a delivery that was made here again: what is intact, and whose signature it has.

    It says what ``recon4 verify`` says on a computer that trusts the keys of this server.
    """
    job = await run_in_threadpool(_export, server, project_id, export_id)
    return await checked(server, job, caller=caller)


@router.delete("/{export_id}/file", responses=REFUSALS, summary="Remove the file of an export")
def remove(project_id: str, export_id: str, *, server: Server, request: Request) -> ExportView:
    """Remove a file; its row stays in the list."""
    job = _export(server, project_id, export_id)
    refuse_others(request, job)
    if not job.over:
        raise Conflict(CodedText("export-not-over"))
    server.exports.remove(job)
    audit(request, "remove export", f"{project_id}: {_file_of(job)}")
    return _view(server, job, latest_map_key(server, project_id), language=language_of(request))


async def _wanted(
    project_id: str, new: NewExport, *, server: ServerParts, caller: Caller
) -> ExportOrder:
    look_up = partial(order_of, server, project_id, new, language=caller.language)
    return await run_in_threadpool(look_up)


async def _estimate(
    project_id: str, wanted: ExportOrder, *, server: ServerParts, caller: Caller
) -> ExportEstimate:
    slices = server.slices
    artifacts = await run_in_threadpool(slices.artifacts, project_id)
    terms = replace(slices.terms(project_id, caller.name), limit_s=KEPT_EXPORTS.estimate_limit_s)
    work: Callable[..., ExportEstimate] = export_work.estimate
    return await caller.wait(slices.run_interactive(terms, work, artifacts, wanted))


def _add(
    project_id: str,
    wanted: ExportOrder,
    server: ServerParts,
    *,
    request: Request,
    expected: ExportEstimate,
) -> ExportView:
    refuse_too_many(server)
    # Refuses an approval that does not count; one that counts is added to a copy of the file.
    approved = server.slices.evidence(project_id, draft=wanted.options.draft) is not None
    beside = max(expected.sorted_bytes, approved * expected.bytes)
    reserve = server.settings.free_disk_reserve_bytes
    needed = expected.bytes + beside + reserve
    free = shutil.disk_usage(server.settings.state).free
    if free < needed:
        raise NoRoom(
            CodedText("export-no-room", needed_bytes=needed, free_bytes=free),
            remedy=STORAGE,
        )
    asked = Inputs(recordings=(), export=wanted)
    job = add_order(server, project_id, asked, request=request)
    audit(request, "export", f"{project_id}: {wanted.file}")
    return _view(server, job, latest_map_key(server, project_id), language=language_of(request))


def _export(server: ServerParts, project_id: str, export_id: str) -> Job:
    return find_order(server, project_id, export_id, kind=JobKind.EXPORT)


def _file_of(job: Job) -> str:
    return job.inputs.export.file if job.inputs.export else ""


def _view(server: ServerParts, job: Job, map_key: str, *, language: str) -> ExportView:
    status = server.supervisor.status(job)
    file = _file_of(job)
    return ExportView(
        id=job.id,
        file=file,
        title=title_of(file),
        options=job.inputs.export.options if job.inputs.export else ExportOptions(),
        state=job.state,
        person=job.person,
        created=job.created,
        finished=job.finished,
        note=job.said(language).note,
        fraction=status.fraction,
        what=status.what,
        made=job.made,
        kept=server.exports.path(job) is not None,
        of_this_map=job.made is not None and job.made.map_key == map_key,
        delivery=job.inputs.export.delivery if job.inputs.export else None,
    )


def _read_choices(path: Path) -> ExportChoices:
    try:
        record = read_object(path, max_bytes=LIMITS.findings_bytes)
        return _CHOICES.validate_python(record)
    except ValidationError as error:
        raise StoreError(at(path.name, str(error))) from error


_CHOICES: TypeAdapter[ExportChoices] = TypeAdapter(ExportChoices)
