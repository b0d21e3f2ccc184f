"""The route of a page of `web/`, as the page itself says."""

from __future__ import annotations

from fastapi import APIRouter, Depends, Request
from fastapi.responses import HTMLResponse

from recon4_app.access.people import Permission, allow_anonymous, needs
from recon4_app.pages import PageAddress, page_response

ANYONE = "anyone"
"""In place of a permission: the page is also for people who have not signed in."""


def add_page(router: APIRouter, address: PageAddress) -> None:
    """Answer with a page.

    Args:
        router: Of the server.
        address: Path, file and permission.

    Raises:
        ValueError: If there is no such permission.
    """
    named = allow_anonymous if address.needs == ANYONE else needs(Permission(address.needs))

    @router.get(
        address.path, include_in_schema=False, dependencies=[Depends(named)], name=address.file
    )
    def read(request: Request) -> HTMLResponse:
        return page_response(address.file, request)
