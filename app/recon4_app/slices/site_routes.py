"""HTTP routes that put a map on control points, by a decision in the journal of its review."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request
from pydantic import Field
from starlette.concurrency import run_in_threadpool

from recon4.model.site_control import SiteControl
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, Who, needs
from recon4_app.compute_pool.messages import decode_record
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.network.request_caller import CalledBy
from recon4_app.pages import Language
from recon4_app.slices import site_work
from recon4_app.slices.model import Strict

LOOK = [Depends(needs(Permission.LOOK))]
REVIEW = [Depends(needs(Permission.REVIEW))]

router = APIRouter(
    prefix="/api/projects/{project_id}/slices/control/site",
    tags=["slices"],
    responses=problems(404, 409, 422),
)


class SiteSystem(Strict):
    """Coordinate system of control points."""

    crs: str = Field(default="", max_length=64)
    """EPSG code or codes of the survey; empty = a grid of the site alone."""


@router.get("", dependencies=LOOK, summary="Try control points")
async def try_site(
    project_id: str,
    server: Server,
    *,
    caller: CalledBy,
    language: Language,
    crs: Annotated[str, Query(max_length=64)] = "",
) -> site_work.SiteTrial:
    """Residuals and tests of the measured points after a rigid fit; nothing is changed."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    state = await run_in_threadpool(server.slices.survey.read, project_id)
    terms = server.slices.terms(project_id, caller.name)
    return await caller.wait(
        server.slices.run_background(
            terms, site_work.try_site, artifacts, state, crs, language=language
        )
    )


@router.post("", status_code=204, dependencies=REVIEW, summary="Put the map on control points")
async def put_on_site(
    project_id: str, system: SiteSystem, server: Server, *, caller: CalledBy
) -> None:
    """Note it in the journal; the map follows when it is made again (``remake``).

    Points that contradict each other are refused. The survey counts as in the map's CRS from now
    on, and the picks are kept in every map that is made afterwards.
    """
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    state = await run_in_threadpool(server.slices.survey.read, project_id)
    terms = server.slices.terms(project_id, caller.name)
    data = await caller.wait(
        server.slices.run_background(
            terms,
            site_work.site_control_of,
            artifacts,
            state,
            system.crs,
            language=caller.language,
        )
    )
    control = decode_record(data, SiteControl)
    await run_in_threadpool(server.slices.survey.keep_seen, project_id, control)
    # The map will have the coordinates of the survey: its points are no longer in a local frame.
    of_site = state.model_copy(update={"frame": "crs"})
    await run_in_threadpool(server.slices.survey.keep, project_id, of_site)
    await run_in_threadpool(_decide, server, project_id, who=caller.name, control=control)
    audit(caller.request, "put map on control points", project_id)


@router.delete("", status_code=204, dependencies=REVIEW, summary="Take the map off them")
def take_off_site(project_id: str, server: Server, *, who: Who, request: Request) -> None:
    """Note in the journal that no control points place the map any more."""
    server.projects.map_of_any_kind(project_id)  # raises if there is no map
    _decide(server, project_id, who=who.name, control=SiteControl(targets=(), crs=""))
    audit(request, "take map off control points", project_id)


def _decide(server: Server, project_id: str, *, who: str, control: SiteControl) -> None:
    root = server.projects.folder(project_id)
    append(root, Decision(kind=DecisionKind.CONTROL, who=who, control=control))
