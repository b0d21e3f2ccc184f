"""HTTP routes of files that become references."""

from __future__ import annotations

from pathlib import Path

from fastapi import APIRouter, Depends
from starlette.concurrency import run_in_threadpool

from recon4_app.access.people import Permission, needs
from recon4_app.compute_pool.model import FileAccess, Terms
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.network.request_caller import CalledBy
from recon4_app.slices import reference_work
from recon4_app.slices.listed_reference import ListedReference
from recon4_app.slices.reference_model import AddReference, ReferenceFile, ReferencePreview
from recon4_app.slices.store import ReferenceFolder

REFERENCE = "reference"
"""Folder that the child process writes in its working folder."""

router = APIRouter(
    prefix="/api/projects/{project_id}/slices/references",
    tags=["slices"],
    dependencies=[Depends(needs(Permission.PROCESS))],
    responses=problems(404, 422),
)


@router.post("/preview", summary="Preview a file of a reference")
async def preview_reference(
    project_id: str, ask: ReferenceFile, server: Server, *, caller: CalledBy
) -> ReferencePreview:
    """First rows of a table, what its columns are taken for, and the question if that is open."""
    path = await run_in_threadpool(server.projects.importable, ask.path)
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    terms = Terms(person=caller.name, access=_reading(path, artifacts))
    return await caller.wait(
        server.slices.run_background(
            terms, reference_work.preview_reference, str(path), artifacts, ask
        )
    )


@router.post("", status_code=201, summary="Add a reference")
async def add_reference(
    project_id: str, add: AddReference, server: Server, *, caller: CalledBy
) -> ListedReference:
    """A cloud or mesh on this computer (PLY, PCD, LAS, LAZ, E57, PTX, XYZ, CSV, OBJ, STL)."""
    path = await run_in_threadpool(server.projects.importable, add.path)
    artifacts = await run_in_threadpool(server.slices.artifacts, project_id)
    out = await run_in_threadpool(server.slices.new_reference, project_id)
    terms = Terms(
        person=caller.name,
        access=_reading(path, artifacts),
        outputs={REFERENCE: out},
        large=True,
    )
    facts = await caller.wait(
        server.slices.write_reference(
            ReferenceFolder(project_id, out),
            terms,
            reference_work.add_reference,
            str(path),
            REFERENCE,
            add,
            artifacts=artifacts,
        )
    )
    return ListedReference.of(out.name, facts, caller.language)


def _reading(path: Path, artifacts: dict[str, str]) -> FileAccess:
    """The file, and of the map what tells its place: its tiles and its georeference."""
    of_map = (Path(folder) for stage, folder in artifacts.items() if stage in ("map", "level"))
    return FileAccess(read=(path, *of_map))
