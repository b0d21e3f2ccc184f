"""HTTP route that leads from the name of a map's file to the export that was made of it."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Depends, Query, Request
from fastapi.responses import RedirectResponse
from pydantic import BaseModel, ConfigDict

from recon4.export.options import ExportOptions
from recon4.locales.coded import CodedText
from recon4_app.access.people import Permission, needs
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.errors import Conflict, NotFound, project_page
from recon4_app.exports.equal_orders import equal_order
from recon4_app.jobs.model import ExportOrder
from recon4_app.network.behind import public_path

router = APIRouter(
    prefix="/api/projects/{project_id}",
    tags=["exports"],
    dependencies=[Depends(needs(Permission.LOOK))],
    responses=problems(404, 409, 422),
)
MapEnding = Literal["copc.laz", "laz", "e57", "ply", "pcd", "xyz", "ptx"]


class MapFileQuery(BaseModel):
    """What of the map is in the file."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    crs: str = ""
    """Code of a CRS, as EPSG:25832; empty = that of the map, or its local frame."""
    raw: bool = False
    """Points where they were measured, not on their surfaces."""
    all_points: bool = False
    """Also those that the map leaves out, by class (not as E57 or PTX): the carrier, noise …"""
    draft: bool = False
    """Without an approval, whether or not there is one."""


@router.get(
    "/map.{ending}",
    status_code=307,
    response_class=RedirectResponse,
    summary="The map as a file that was exported",
)
def map_file(
    project_id: str,
    ending: MapEnding,
    query: Annotated[MapFileQuery, Query()],
    *,
    request: Request,
    server: Server,
) -> RedirectResponse:
    """Lead to the newest export of the present map with these options.

    404 if there is none: order it with ``POST …/exports``. 409 while it is made.
    """
    options = ExportOptions(**query.model_dump())
    job = equal_order(server, project_id, ExportOrder(file=f"map.{ending}", options=options))
    if job is None:
        missing = CodedText("export-not-ordered", file=f"map.{ending}", project=project_id)
        raise NotFound(missing, remedy=project_page(project_id))
    if not job.over:
        raise Conflict(CodedText("export-being-made", file=f"map.{ending}"))
    path = f"/api/projects/{project_id}/exports/{job.id}/file"
    return RedirectResponse(public_path(request.scope, path), status_code=307)
