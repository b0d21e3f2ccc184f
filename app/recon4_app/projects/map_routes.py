"""HTTP route of the map as a file of another format."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, Query
from fastapi.responses import FileResponse
from starlette.concurrency import run_in_threadpool

from recon4_app.access.people import Permission, needs
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.network.request_caller import CalledBy
from recon4_app.projects.map_file import MapEnding, MapFileQuery, MapFileRequest

router = APIRouter(
    prefix="/api/projects/{project_id}",
    tags=["projects"],
    dependencies=[Depends(needs(Permission.LOOK))],
    responses=problems(404, 422),
)


@router.get("/map.{ending}", response_class=FileResponse, summary="Map in another format")
async def map_file(
    project_id: str,
    ending: MapEnding,
    query: Annotated[MapFileQuery, Query()],
    *,
    server: Server,
    caller: CalledBy,
) -> FileResponse:
    """Write the map as COPC, LAZ, E57 (scans with poses), PLY, PCD or XYZ, in any CRS.

    The work is canceled when the client disconnects. A finished file is kept for a day: the same
    request with ``Range`` continues an interrupted download.
    """
    slices = server.slices
    evidence = await run_in_threadpool(slices.evidence, project_id, draft=query.draft)
    artifacts = await run_in_threadpool(slices.approved_artifacts, project_id, "", evidence)
    request = MapFileRequest(ending=ending, query=query, artifacts=artifacts, evidence=evidence)
    terms = slices.terms(project_id, caller.name)
    return FileResponse(
        await caller.wait(slices.exports.make(request, terms)),
        filename=f"{project_id}-map.{ending}",
        media_type="application/octet-stream",
    )
