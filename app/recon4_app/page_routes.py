"""The route of a page of `web/`, as the page itself says."""

from __future__ import annotations

from collections.abc import Callable
from urllib.parse import quote

from fastapi import APIRouter, Depends, Request, Response
from fastapi.responses import RedirectResponse

from recon4_app.access.people import Permission, allow_anonymous, needs
from recon4_app.deps import Server, ServerParts
from recon4_app.errors import NotFound
from recon4_app.network.behind import prefix_of
from recon4_app.pages import OF_PROJECT, PageAddress, page_response

ANYONE = "anyone"
"""In place of a permission: the page is also for people who have not signed in."""
PageHead = Callable[[str, Request], str]
"""HTML in front of the title of a page, for one project."""


def no_head(project_id: str, request: Request) -> str:
    """Nothing in front of the title."""
    return ""


def add_page(router: APIRouter, address: PageAddress, head: PageHead = no_head) -> None:
    """Answer with a page; with one of a project only if there is such a project.

    Args:
        router: Of the server.
        address: Path, file and permission.
        head: Of a page of one project.

    Raises:
        ValueError: If there is no such permission.
    """
    named = allow_anonymous if address.needs == ANYONE else needs(Permission(address.needs))
    route = router.get(
        address.path, include_in_schema=False, dependencies=[Depends(named)], name=address.file
    )

    def read(request: Request) -> Response:
        return page_response(address.file, request)

    def read_of_project(project_id: str, request: Request, server: Server) -> Response:
        if _waits(project_id, server) and address.path != OF_PROJECT:
            progress = OF_PROJECT.format(project_id=quote(project_id, safe=""))
            return RedirectResponse(prefix_of(request.scope) + progress, status_code=303)
        return page_response(address.file, request, head=head(project_id, request))

    route(read_of_project if address.path.startswith(OF_PROJECT) else read)


def _waits(project_id: str, server: ServerParts) -> bool:
    """Whether a project has no folder yet, because its first job waits.

    Raises:
        NotFound: If there is neither such a project nor a job that will make it.
    """
    try:
        server.projects.folder(project_id)
    except NotFound:
        if not server.jobs.of_project(project_id):
            raise
        return True
    return False
