"""HTTP routes of the storage: what takes space, and deleting uploaded recordings."""

from __future__ import annotations

from fastapi import APIRouter, Depends, Request
from pydantic import BaseModel, ConfigDict, Field

from recon4.archive.space import Freeable
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, needs
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.projects.trash import Deleted
from recon4_app.storage.model import ProjectSpace, ProjectStorage, StorageView
from recon4_app.storage.storage_work import delete_recording, read_project_storage, read_storage


class FreeRequest(BaseModel):
    """What is to be removed."""

    model_config = ConfigDict(extra="forbid")

    what: list[Freeable] = Field(min_length=1, max_length=len(Freeable))


PROCESS = [Depends(needs(Permission.PROCESS))]

router = APIRouter(
    prefix="/api",
    tags=["storage"],
    dependencies=PROCESS,
    responses=problems(404, 409),
)


@router.get("/storage", summary="What takes space")
def storage(server: Server) -> StorageView:
    """List projects, uploaded recordings, unfinished uploads and the trash with their sizes."""
    return read_storage(server)


@router.get("/storage/projects", summary="Space of the projects")
def list_project_space(server: Server) -> list[ProjectSpace]:
    """List how much space each project takes, and what of it can be freed."""
    return server.project_spaces.all()


@router.get("/projects/{project_id}/storage", summary="What takes the space of a project")
def project_storage(project_id: str, server: Server) -> ProjectStorage:
    """List the parts of a project with their sizes, and which of them can be made again."""
    return read_project_storage(server, project_id)


@router.post("/projects/{project_id}/free", summary="Free space of a project")
def free_project_space(
    project_id: str, asked: FreeRequest, server: Server, *, request: Request
) -> ProjectSpace:
    """Remove what processing the recording makes again. What an approval needs always stays.

    Without ``frames`` there are no new decisions and no views of pairs, without ``map`` no viewer,
    slices and exports, until the recording was processed again.
    """
    left = server.project_spaces.free(project_id, asked.what)
    audit(request, "free space", f"{project_id}: {', '.join(asked.what)}")
    return left


@router.delete("/recordings/{name}", summary="Delete a recording")
def remove_recording(name: str, server: Server, request: Request) -> Deleted:
    """Move an uploaded recording to the trash; it can be restored for a week.

    Projects made from it keep their maps, but cannot be processed from it again. Not while a job
    reads it.
    """
    deleted = delete_recording(server, name)
    audit(request, "delete recording", name)
    return deleted
