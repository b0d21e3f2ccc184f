"""HTTP routes of the projects."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Literal

from fastapi import APIRouter, Depends, Request, Response
from fastapi.responses import FileResponse, HTMLResponse, PlainTextResponse, StreamingResponse
from pydantic import BaseModel, ConfigDict, Field
from starlette.concurrency import run_in_threadpool

from recon4.findings.in_language import summary_in
from recon4.locales.coded import CodedText
from recon4.review.acknowledgments import report_with_notes
from recon4.review.state import artifact_keys
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, Who, needs
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import Conflict
from recon4_app.names import Name
from recon4_app.network.request_caller import CalledBy
from recon4_app.pages import Language
from recon4_app.projects.inspect_recording import RecordingSummary, files_beside, inspect_recording
from recon4_app.projects.model import (
    MAP_IMAGES,
    FolderEntry,
    ProjectCard,
    ProjectView,
    for_guests,
)
from recon4_app.projects.trash import Deleted
from recon4_app.projects.tuning import LOOKS, PROJECT_LIST

LOOK = [Depends(needs(Permission.LOOK))]
SHARED = [Depends(needs(Permission.SHARED))]
router = APIRouter(
    prefix="/api",
    tags=["projects"],
    responses=problems(404),
)

PROCESS = [Depends(needs(Permission.PROCESS))]
REPORT_POLICY = "sandbox; default-src 'none'; style-src 'unsafe-inline'; img-src data:"
"""A report is a file of the project: it may load nothing else."""


FINDINGS_TYPES = {"csv": "text/csv; charset=utf-8", "geojson": "application/geo+json"}


Tag = Annotated[Name, Field(min_length=1, max_length=PROJECT_LIST.max_tag)]


class ProjectChanges(BaseModel):
    """What people say of a project; a field that is left out stays."""

    model_config = ConfigDict(extra="forbid")

    name: Name | None = Field(default=None, min_length=1, max_length=100)
    """Display name; any letters."""
    tags: list[Tag] | None = Field(default=None, max_length=PROJECT_LIST.max_tags)
    """Words by which people find it, as that of a site, a customer or a day."""
    archived: bool | None = None
    """Whether the list leaves it out at first; nothing is moved or deleted."""

    def fields(self) -> dict[str, object]:
        """What is changed, by its name in ``project.json``."""
        given = self.model_dump(exclude_none=True)
        if self.name is not None:
            given["name"] = self.name.strip()
        if self.tags is not None:
            texts = [" ".join(one.split()) for one in self.tags]
            given["tags"] = [*{one.casefold(): one for one in texts if one}.values()]
        return given


class Restored(BaseModel):
    """A restored project or recording."""

    project: str
    """Name of its folder."""


@router.get("/projects", dependencies=LOOK, summary="Projects")
def list_projects(server: Server, language: Language) -> list[ProjectCard]:
    """List all projects, the newest first."""
    root = server.settings.root.resolve()
    known = server.checks.known
    return [
        replace(card, approval=known(root / card.id, card.approval).in_language(language))
        for card in server.projects.all()
    ]


@router.get("/projects/{project_id}", dependencies=SHARED, summary="One project")
def read_project(project_id: str, server: Server, who: Who, *, language: Language) -> ProjectView:
    """Read a project with its results and finished stages; guests get what their pages show.

    The findings in its summary are in the language of the request.
    """
    project = _compared(server, server.projects.get(project_id), language)
    project = replace(project, summary=summary_in(language, project.summary))
    return for_guests(project) if who.project else project


@router.patch("/projects/{project_id}", dependencies=PROCESS, summary="Change a project")
def change_project(
    project_id: str, new: ProjectChanges, server: Server, *, request: Request, language: Language
) -> ProjectView:
    """Change display name or tags of a project, or archive it. Not while a job runs.

    Its folder and URLs stay.
    """
    fields = new.fields()
    server.projects.describe(project_id, fields)
    said = ", ".join(f"{name} {value}" for name, value in fields.items())
    audit(request, "change project", f"{project_id}: {said}")
    return _compared(server, server.projects.get(project_id), language)


@router.delete("/projects/{project_id}", dependencies=PROCESS, summary="Delete a project")
def delete_project(project_id: str, server: Server, request: Request, *, who: Who) -> Deleted:
    """Move a project to the trash; it can be restored for a week. Not while a job runs.

    Its guest links are revoked, for good.
    """
    folder = server.projects.folder(project_id)
    _refuse_while_busy(server, project_id)
    server.access.guests.revoke_all(project_id, who)  # first: another project may get its name
    deleted = server.trash.put(folder)
    server.jobs.move_made(project_id, deleted.id)
    audit(request, "delete project", project_id)
    return deleted


@router.get("/trash", dependencies=PROCESS, summary="Trash")
def list_trash(server: Server) -> list[Deleted]:
    """List deleted projects and recordings that can be restored."""
    return server.trash.all()


@router.post("/trash/{deleted_id}/restore", dependencies=PROCESS, summary="Restore from the trash")
def restore_project(deleted_id: str, server: Server, request: Request) -> Restored:
    """Restore a deleted project or recording under its old name."""
    project = server.trash.restore(deleted_id)
    server.jobs.move_made(deleted_id, project)
    audit(request, "restore", project)
    return Restored(project=project)


@router.delete(
    "/trash/{deleted_id}", status_code=204, dependencies=PROCESS, summary="Remove from the trash"
)
def remove_project(deleted_id: str, server: Server, request: Request) -> None:
    """Remove a deleted project or recording permanently."""
    server.trash.remove(deleted_id)
    audit(request, "remove", deleted_id)


@router.get(
    "/projects/{project_id}/files/{name}",
    response_class=FileResponse,
    dependencies=LOOK,
    summary="Download a result",
)
def download(project_id: str, name: str, server: Server) -> FileResponse:
    """Download a result file."""
    path = server.projects.result(project_id, name)
    return FileResponse(
        path, filename=f"{project_id}-{name}", media_type="application/octet-stream"
    )


@router.get(
    "/projects/{project_id}/report",
    response_class=HTMLResponse,
    dependencies=SHARED,
    summary="Report",
)
def report(project_id: str, server: Server, who: Who, *, language: Language) -> Response:
    """Show the quality report; that of a draft with the notes of reviewers, except to guests.

    It is in the language of the request; the file of the run is in English.
    """
    from recon4.delivery.report_files import said_report  # brings what draws

    path = server.projects.result(project_id, "report.html")
    root = server.projects.folder(project_id)
    page = [path.read_bytes()] if who.project else report_with_notes(root, path)
    return StreamingResponse(
        iter(said_report(root, page, language)),
        media_type="text/html; charset=utf-8",
        headers={"Content-Security-Policy": REPORT_POLICY},
    )


@router.get(
    "/projects/{project_id}/findings.{ending}",
    response_class=PlainTextResponse,
    dependencies=LOOK,
    summary="Findings as a table or for a GIS",
)
def findings(
    project_id: str, ending: Literal["csv", "geojson"], server: Server
) -> PlainTextResponse:
    """Download the findings of the map: CSV in its CRS, or GeoJSON in longitude and latitude; of a
    map that is not georeferenced both in its local frame.
    """
    from recon4.export.findings import findings_file  # brings pyproj

    _, text = findings_file(server.projects.folder(project_id), f".{ending}")
    head = {"Content-Disposition": f'attachment; filename="{project_id}-findings.{ending}"'}
    return PlainTextResponse(text, media_type=FINDINGS_TYPES[ending], headers=head)


@router.get(
    "/projects/{project_id}/thumbnail",
    response_class=FileResponse,
    dependencies=SHARED,
    summary="Thumbnail",
)
async def thumbnail(project_id: str, server: Server, caller: CalledBy) -> FileResponse:
    """The map from above as PNG image, made at the first request; a 2-D map is its own image."""
    artifact = await run_in_threadpool(server.projects.map_of_any_kind, project_id)
    for image in MAP_IMAGES:
        if (artifact / image).is_file():
            return FileResponse(artifact / image, media_type="image/png")
    return FileResponse(await caller.wait(server.thumbnails.of(artifact, person=caller.name)))


@router.get(
    "/recordings",
    dependencies=[Depends(needs(Permission.PROCESS))],
    responses=problems(403),
    summary="Folders of this computer",
)
def browse(server: Server, folder: str = "") -> list[FolderEntry]:
    """List files and folders of this computer to select a recording."""
    return server.projects.browse(folder)


@router.get(
    "/look",
    dependencies=PROCESS,
    responses=problems(403, 422, 503),
    summary="Inspect a recording",
)
async def look(
    path: str, server: Server, caller: CalledBy, *, language: Language
) -> RecordingSummary:
    """Inspect a recording on this computer: content and suitable settings."""
    real = await run_in_threadpool(server.projects.importable, path)
    beside = await run_in_threadpool(files_beside, real)
    terms = Terms(
        person=caller.name, access=FileAccess(read=(real, *beside)), limit_s=LOOKS.look_limit_s
    )
    return await caller.wait(
        server.compute_pool.run_background(
            Lane.INSPECT, terms, inspect_recording, real, beside, language
        )
    )


def _compared(server: ServerParts, project: ProjectView, language: str) -> ProjectView:
    """A project with the outcome of the comparison of its files with their signature."""
    found = project.approval
    if found.hash:
        root, keys = server.projects.folder(project.id), artifact_keys(project.summary)
        found = server.checks.compared(root, keys, found, within_s=LOOKS.compared_within_s)
    return replace(project, approval=found.in_language(language))


def _refuse_while_busy(server: ServerParts, project_id: str) -> None:
    if server.jobs.is_used(project_id):
        raise Conflict(CodedText("project-has-job", project=project_id))
