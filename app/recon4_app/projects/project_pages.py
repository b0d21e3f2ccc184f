"""Pages about the map of a project: served once there is a folder of it."""

from __future__ import annotations

from urllib.parse import quote

from fastapi import Request, Response
from fastapi.responses import RedirectResponse

from recon4_app.deps import ServerParts
from recon4_app.errors import NotFound
from recon4_app.network.behind import prefix_of
from recon4_app.pages import page_response


def map_page_response(
    file: str, request: Request, *, server: ServerParts, project_id: str, head: str = ""
) -> Response:
    """A page; while the first job of the project waits, the way to where its progress is shown.

    Args:
        file: Path of the page, relative to `web/`.
        request: Its server may have a prefix.
        server: Its projects and jobs.
        project_id: Name of the project's folder, which a waiting job has not made yet.
        head: HTML in front of the title of the page.

    Raises:
        NotFound: If there is neither such a project nor a job that will make it.
    """
    try:
        server.projects.folder(project_id)
    except NotFound:
        if not server.jobs.of_project(project_id):
            raise
        address = f"{prefix_of(request.scope)}/projects/{quote(project_id, safe='')}/"
        return RedirectResponse(address, status_code=303)
    return page_response(file, request, head=head)
