"""HTTP routes of guest links: who makes and revokes them, and who opens one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, Depends, Path, Request, Response
from pydantic import Field

from recon4.locales.coded import CodedText
from recon4_app.access.audit import address, audit
from recon4_app.access.guests.guest_links import GuestLink
from recon4_app.access.login.routes import Text, Wire, enter_guest
from recon4_app.access.people import (
    Permission,
    Role,
    Who,
    allow_anonymous,
    interactive_login,
    needs,
)
from recon4_app.access.tuning import GUEST_LINK
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import AppError, Conflict, Refused
from recon4_app.names import Name

SHARE = [Depends(needs(Permission.SHARE)), Depends(interactive_login)]
LinkId = Annotated[str, Path(pattern="^[0-9a-f]{12}$")]

router = APIRouter(
    prefix="/api",
    tags=["guests"],
    responses=problems(403, 404, 409, 429),
)


class NewGuestLink(Wire):
    """A link to make."""

    label: Annotated[Name, Field(min_length=1, max_length=64)]
    """For whom it is."""
    days: Annotated[int, Field(ge=1, le=GUEST_LINK.max_days)]
    """When it expires, in days from now."""


class GuestToken(Wire):
    """Token of a link, from the fragment of its address."""

    token: Text


@dataclass(frozen=True, slots=True, kw_only=True)
class GuestLinksView:
    """The guest links of a project."""

    login: bool
    """Whether people sign in to this server; else there are no guests."""
    links: list[GuestLink]
    """The newest first."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NewGuestLinkView:
    """A link that was just made: only now is its token known."""

    link: GuestLink
    token: str


@dataclass(frozen=True, slots=True, kw_only=True)
class GuestPlace:
    """Where a guest may look."""

    project: str


@router.get("/projects/{project_id}/guests", dependencies=SHARE, summary="Guest links")
def list_guest_links(project_id: str, server: Server) -> GuestLinksView:
    """Links to a project: for whom, by whom, until when, how often they were opened."""
    server.projects.folder(project_id)
    links = server.access.guests.of_project(project_id)
    return GuestLinksView(login=server.access.login, links=links)


@router.post(
    "/projects/{project_id}/guests", status_code=201, dependencies=SHARE, summary="Make a link"
)
def make_guest_link(
    project_id: str, new: NewGuestLink, server: Server, *, who: Who, request: Request
) -> NewGuestLinkView:
    """The address is ``/guest#TOKEN``; the token is stored nowhere and shown this once."""
    server.projects.folder(project_id)
    _with_login(server)
    link, token = server.access.guests.make(project_id, who, label=new.label, days=new.days)
    audit(request, "share", f"{project_id}: {link.id} for {link.label}, {new.days} days")
    return NewGuestLinkView(link=link, token=token)


@router.delete("/projects/{project_id}/guests/{link_id}", dependencies=SHARE, summary="Revoke it")
def revoke_guest_link(
    project_id: str, link_id: LinkId, server: Server, *, who: Who, request: Request
) -> GuestLink:
    """The link opens nothing from now on, and the sessions of its guests end."""
    guests = server.access.guests
    guests.revoke(guests.one(project_id, link_id), who)
    audit(request, "revoke guest link", f"{project_id}: {link_id}")
    return guests.one(project_id, link_id)


@router.post("/guests/open", dependencies=[Depends(allow_anonymous)], summary="Open a link")
def open_guest_link(
    given: GuestToken, request: Request, response: Response, *, server: Server
) -> GuestPlace:
    """Exchange the token of a link for the cookie of a session, which shows one project."""
    _with_login(server)
    session = request.scope["state"].get("session")
    if session is not None and session.role is not Role.GUEST:
        raise Refused(CodedText("guest-signed-in-already"))
    log, place = server.access.log, address(request)
    try:
        agent = request.headers.get("user-agent", "")
        entry = server.access.guests.open(given.token, address=place, agent=agent)
    except AppError as error:
        log.add("nobody", place, action="open guest link", what=str(error), outcome="failed")
        raise
    link = entry.link
    log.add("nobody", place, action="open guest link", what=f"{link.project}: {link.id}")
    enter_guest(server.access, request, response, entry=entry)
    return GuestPlace(project=link.project)


def _with_login(server: ServerParts) -> None:
    if not server.access.login:
        raise Conflict(CodedText("guests-need-login"))
