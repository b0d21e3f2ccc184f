"""HTTP routes that find survey targets in a whole map: a job, its progress and what it found."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request
from starlette.concurrency import run_in_threadpool

from recon4.locales.coded import CodedText
from recon4.slices.targets.named import TargetList
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, needs
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import NotFound
from recon4_app.exports.tuning import KEPT_EXPORTS
from recon4_app.jobs.model import Inputs, Job, JobKind, TargetOrder
from recon4_app.jobs.orders import add_order, find_order, latest_map_key, refuse_others
from recon4_app.jobs.routes import refuse_too_many
from recon4_app.network.rate_limit import at_most
from recon4_app.network.request_caller import CalledBy
from recon4_app.pages import Language, language_of
from recon4_app.slices import readers, target_work
from recon4_app.slices.target_model import TargetSearch
from recon4_app.slices.tuning import SLICE_REQUESTS

router = APIRouter(
    prefix="/api/projects/{project_id}/slices/control/targets",
    tags=["slices"],
    dependencies=[Depends(needs(Permission.LOOK))],
    responses=problems(404, 422),
)
ORDER = [Depends(at_most(60, within_s=3600.0, what="target-searches"))]
REFUSALS = problems(403, 429)


@router.get("", summary="Searches for survey targets")
def list_searches(project_id: str, server: Server, *, language: Language) -> list[TargetSearch]:
    """List the searches of a project, the newest first."""
    server.projects.folder(project_id)
    jobs = server.jobs.of_project(project_id, JobKind.TARGETS)[: KEPT_EXPORTS.listed]
    map_key = latest_map_key(server, project_id)
    return [_view(server, job, map_key, language=language) for job in jobs]


@router.post(
    "", status_code=201, dependencies=ORDER, responses=REFUSALS, summary="Find survey targets"
)
def order(project_id: str, *, server: Server, request: Request) -> TargetSearch:
    """Look for plates, boards and spheres in the whole map, as a job beside those that process.

    If the same search of this map waits, runs or is kept, that one is returned.
    """
    server.slices.artifacts(project_id)  # raises if there is no map
    points = server.slices.survey.read(project_id).points
    radii = sorted({round(one.radius_m, 4) for one in points if one.radius_m > 0.0})
    wanted = TargetOrder(radii_m=tuple(radii[: SLICE_REQUESTS.radii]))
    map_key = latest_map_key(server, project_id)
    job = _equal(server, project_id, wanted, map_key=map_key)
    if job is None:
        refuse_too_many(server)
        inputs = Inputs(recordings=(), targets=wanted)
        job = add_order(server, project_id, inputs, request=request)
        audit(request, "find targets", project_id)
    return _view(server, job, map_key, language=language_of(request))


@router.get("/{search_id}", summary="A search for survey targets")
def read_search(
    project_id: str, search_id: str, server: Server, *, language: Language
) -> TargetSearch:
    """Its state and progress."""
    job = _search(server, project_id, search_id)
    return _view(server, job, latest_map_key(server, project_id), language=language)


@router.post("/{search_id}/cancel", responses=REFUSALS, summary="Cancel a search for targets")
def cancel(project_id: str, search_id: str, *, server: Server, request: Request) -> TargetSearch:
    """Stop a search; nothing of it is left."""
    job = _search(server, project_id, search_id)
    refuse_others(request, job)
    job = server.supervisor.cancel(job)
    audit(request, "cancel search for targets", project_id)
    return _view(server, job, latest_map_key(server, project_id), language=language_of(request))


@router.get("/{search_id}/found", summary="Survey targets that were found")
async def read_found(
    project_id: str,
    search_id: str,
    server: Server,
    *,
    caller: CalledBy,
    crs: Annotated[str, Query(max_length=64)] = "",
) -> TargetList:
    """Plates, boards and spheres, named by the survey that is stored now; proposals only."""
    job = await run_in_threadpool(_search, server, project_id, search_id)
    path = await run_in_threadpool(server.exports.path, job)
    if path is None:
        raise NotFound(CodedText("targets-gone"))
    found = await run_in_threadpool(readers.read_targets, path)
    slices = server.slices
    state = await run_in_threadpool(slices.survey.read, project_id)
    terms = slices.terms(project_id, caller.name)
    return await caller.wait(
        slices.run_interactive(terms, target_work.name_targets, found, state, crs)
    )


def _search(server: ServerParts, project_id: str, search_id: str) -> Job:
    return find_order(server, project_id, search_id, kind=JobKind.TARGETS)


def _equal(
    server: ServerParts, project_id: str, wanted: TargetOrder, *, map_key: str
) -> Job | None:
    """The newest search of this map for the same: it waits, runs, or what it found is kept."""
    for job in server.jobs.of_project(project_id, JobKind.TARGETS):
        if job.inputs.targets != wanted:
            continue
        made = job.made if server.exports.path(job) else None
        if not job.over or (made and made.map_key == map_key):
            return job
    return None


def _view(server: ServerParts, job: Job, map_key: str, *, language: str) -> TargetSearch:
    status = server.supervisor.status(job)
    return TargetSearch(
        id=job.id,
        state=job.state,
        person=job.person,
        created=job.created,
        note=job.said(language).note,
        step=status.what,
        fraction=status.fraction,
        kept=server.exports.path(job) is not None,
        of_this_map=job.made is not None and job.made.map_key == map_key,
    )
