"""HTTP routes to align a reference with the map."""

from __future__ import annotations

from pathlib import Path

from fastapi import APIRouter, Depends
from starlette.concurrency import run_in_threadpool

from recon4_app.access.people import Permission, needs
from recon4_app.compute_pool.model import FileAccess, Terms
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.network.request_caller import CalledBy
from recon4_app.slices import align_work
from recon4_app.slices.listed_reference import ListedReference
from recon4_app.slices.model import AlignPoints, AlignRequest
from recon4_app.slices.store import ReferenceFolder

router = APIRouter(
    prefix="/api/projects/{project_id}/slices/references/{reference_id}",
    tags=["slices"],
    dependencies=[Depends(needs(Permission.PROCESS))],
    responses=problems(404, 422),
)


@router.post("/align", summary="Align it")
async def align(
    project_id: str, reference_id: str, ask: AlignRequest, *, server: Server, caller: CalledBy
) -> ListedReference:
    """Align a reference with the map: by ICP, by pairs of points, not at all, or as before."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    folder = server.slices.reference(project_id, reference_id)
    terms = Terms(
        person=caller.name,
        access=FileAccess(read=(Path(artifacts["map"]),), write=(Path(folder),)),
        large=True,
    )
    facts = await caller.wait(
        server.slices.write_reference(
            ReferenceFolder(project_id, Path(folder)),
            terms,
            align_work.align_reference,
            artifacts["map"],
            folder,
            ask,
        )
    )
    return ListedReference.of(reference_id, facts, caller.language)


@router.get("/points", summary="Points of map and reference")
async def align_points(
    project_id: str, reference_id: str, *, server: Server, caller: CalledBy
) -> AlignPoints:
    """A sample of both, for a person to lay them on each other."""
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    folder = server.slices.reference(project_id, reference_id)
    terms = server.slices.terms(project_id, caller.name)
    return await caller.wait(
        server.slices.run_background(terms, align_work.align_points, artifacts["map"], folder)
    )
