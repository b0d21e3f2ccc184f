"""HTTP face of the projects: parse, delegate, answer."""

from __future__ import annotations

from fastapi import APIRouter
from fastapi.responses import FileResponse

from app.deps import Server
from app.errors import Problem
from app.projects.model import Entry, Project

router = APIRouter(prefix="/api", tags=["projects"], responses={404: {"model": Problem}})

REPORT_POLICY = "sandbox; default-src 'none'; style-src 'unsafe-inline'; img-src data:"
"""A report is a file of the project: it may show itself and nothing more."""


@router.get("/projects")
def list_projects(server: Server) -> list[Project]:
    """All projects, the newest first."""
    return server.projects.all()


@router.get("/projects/{project_id}")
def read_project(project_id: str, server: Server) -> Project:
    """One project."""
    return server.projects.get(project_id)


@router.get("/projects/{project_id}/files/{name}", response_class=FileResponse)
def download(project_id: str, name: str, server: Server) -> FileResponse:
    """A result file, as a download."""
    path = server.projects.result(project_id, name)
    return FileResponse(
        path, filename=f"{project_id}-{name}", media_type="application/octet-stream"
    )


@router.get("/projects/{project_id}/report", response_class=FileResponse)
def report(project_id: str, server: Server) -> FileResponse:
    """The quality report, to look at."""
    path = server.projects.result(project_id, "report.html")
    policy = {"Content-Security-Policy": REPORT_POLICY}
    return FileResponse(path, media_type="text/html; charset=utf-8", headers=policy)


@router.get("/projects/{project_id}/picture", response_class=FileResponse)
async def picture(project_id: str, server: Server) -> FileResponse:
    """The map from above, PNG; drawn when it is asked for the first time."""
    return FileResponse(await server.pictures.of(server.projects.map_artifact(project_id)))


@router.get("/recordings", responses={403: {"model": Problem}})
def browse(server: Server, folder: str = "") -> list[Entry]:
    """Files and folders of this computer a recording may be picked from."""
    return server.projects.browse(folder)
