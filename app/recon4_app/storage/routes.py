"""HTTP routes of the storage: what takes space, and deleting uploaded recordings."""

from __future__ import annotations

from fastapi import APIRouter, Depends, Request
from fastapi.responses import HTMLResponse

from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, needs
from recon4_app.deps import Server
from recon4_app.error_responses import ProblemDetail
from recon4_app.pages import page_response
from recon4_app.projects.trash import Deleted
from recon4_app.storage.model import StorageView
from recon4_app.storage.storage_work import delete_recording, read_storage

PROCESS = [Depends(needs(Permission.PROCESS))]

router = APIRouter(
    prefix="/api",
    tags=["storage"],
    dependencies=PROCESS,
    responses={404: {"model": ProblemDetail}, 409: {"model": ProblemDetail}},
)
page = APIRouter()


@page.get("/storage", include_in_schema=False, dependencies=PROCESS)
def storage_page(request: Request) -> HTMLResponse:
    return page_response("storage/storage.html", request)


@router.get("/storage", summary="What takes space")
def storage(server: Server) -> StorageView:
    """List projects, uploaded recordings, unfinished uploads and the trash with their sizes."""
    return read_storage(server)


@router.delete("/recordings/{name}", summary="Delete a recording")
def remove_recording(name: str, server: Server, request: Request) -> Deleted:
    """Move an uploaded recording to the trash; it can be restored for a week.

    Projects made from it keep their maps, but cannot be processed from it again. Not while a job
    reads it.
    """
    deleted = delete_recording(server, name)
    audit(request, "delete recording", name)
    return deleted
