"""HTTP face of pairing: the laptop's side and the phone's."""

from __future__ import annotations

import ipaddress
from dataclasses import dataclass
from typing import Annotated
from urllib.parse import urlsplit

import segno
from fastapi import APIRouter, Depends, Request, Response
from pydantic import Field

from app.access.audit import address, audit
from app.access.login.routes import Me, Text, Wire, enter_paired
from app.access.pairing.grants import INVITATION_S, REQUEST_S, PairingGrant, roles_for
from app.access.people import (
    Permission,
    Person,
    Role,
    Who,
    allow_anonymous,
    interactive_login,
    needs,
)
from app.deps import Server
from app.errors import AppError, Conflict, ProblemDetail, Refused
from app.names import Name
from app.network.hosts import LOOPBACK, own_addresses
from app.network.listen import presented_fingerprint

router = APIRouter(
    prefix="/api/pairing",
    tags=["phones"],
    responses={
        403: {"model": ProblemDetail},
        409: {"model": ProblemDetail},
        429: {"model": ProblemDetail},
    },
)
ALLOW_ANONYMOUS = [Depends(allow_anonymous)]
LET_IN = [Depends(needs(Permission.LOOK)), Depends(interactive_login)]


class NewInvitation(Wire):
    """What the phone may."""

    role: Role


class Token(Wire):
    """What the phone was given."""

    token: Text


class NewRequest(Wire):
    """A phone that wants in."""

    name: Annotated[Name, Field(max_length=64)] = ""
    """What it calls itself."""


class PairingApproval(Wire):
    """The digits a phone shows, and what it may."""

    code: Annotated[str, Field(pattern=r"^[0-9]{6}$")]
    role: Role


@dataclass(frozen=True, slots=True, kw_only=True)
class PairingView:
    """What a person can do about phones."""

    login: bool
    """Whether phones can be let in at all: else the server listens to this computer only."""
    roles: list[Role]
    """What phones this person may let in."""
    fingerprint: str
    """SHA-256 of the certificate, to compare on the phone."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PairingLink:
    """A way for the phone to this computer."""

    host: str
    url: str
    """With the one-time token in its fragment, which browsers send nowhere."""
    qr: str
    """The same as a picture: an SVG as data URI."""


@dataclass(frozen=True, slots=True, kw_only=True)
class InvitationView:
    """An invitation to be shown."""

    links: list[PairingLink]
    """One for each address of this computer, the likeliest first; all are the same invitation."""
    seconds: float
    """So long it is good."""
    role: Role


@dataclass(frozen=True, slots=True, kw_only=True)
class PairingRequestView:
    """What a phone shows, and what it keeps to itself."""

    code: str
    token: str
    seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Approved:
    """The phone that was let in."""

    name: str
    address: str


@router.get("", dependencies=LET_IN, summary="How phones get in")
def read_pairing(server: Server, who: Who) -> PairingView:
    """What this person can do about phones, and the certificate they should see."""
    fingerprint = presented_fingerprint(server.settings)
    return PairingView(
        login=server.access.login, roles=roles_for(who), fingerprint=fingerprint or ""
    )


@router.post("/invitations", status_code=201, dependencies=LET_IN, summary="A QR code for a phone")
def invite(new: NewInvitation, request: Request, server: Server, who: Who) -> InvitationView:
    """A one-time link for one phone, good for two minutes."""
    _with_login(server)
    token = server.access.pairings.invite(who, new.role)
    audit(request, "invite phone", new.role)
    links = [_link(host, request, token) for host in _hosts(request)]
    return InvitationView(links=links, seconds=INVITATION_S, role=new.role)


@router.post("/redeem", dependencies=ALLOW_ANONYMOUS, summary="Use an invitation")
def redeem(given: Token, request: Request, response: Response, server: Server) -> Me:
    """The phone's side of the QR code; the answer sets the cookie of the session."""
    _with_login(server)
    _signed_out(request)
    try:
        grant = server.access.pairings.redeem(given.token, address(request))
    except AppError as error:
        _note_failure(request, server, str(error))
        raise
    return enter_paired(server.access, request, response, grant=grant)


@router.post("/requests", status_code=201, dependencies=ALLOW_ANONYMOUS, summary="Ask to be let in")
def ask(new: NewRequest, request: Request, server: Server) -> PairingRequestView:
    """Six digits to show; somebody who is signed in types them at ``/phone``."""
    _with_login(server)
    _signed_out(request)
    asked = server.access.pairings.ask(new.name, address(request))
    return PairingRequestView(code=asked.code, token=asked.token, seconds=REQUEST_S)


@router.post("/claim", dependencies=ALLOW_ANONYMOUS, summary="Was this phone let in?")
def claim(given: Token, request: Request, response: Response, server: Server) -> Me | None:
    """Null while the phone waits; once it is let in the answer sets the cookie of the session."""
    _with_login(server)
    _signed_out(request)
    grant: PairingGrant | None = server.access.pairings.claim(given.token)
    if grant is None:
        return None
    return enter_paired(server.access, request, response, grant=grant)


@router.post("/approve", dependencies=LET_IN, summary="Let in the phone that shows these digits")
def approve(given: PairingApproval, request: Request, server: Server, who: Who) -> Approved:
    """Type the digits somebody reads to you from a phone you see."""
    _with_login(server)
    try:
        found = server.access.pairings.approve(given.code, Person(who.name, who.role), given.role)
    except AppError as error:
        audit(request, "let in phone", str(error), outcome="failed")
        raise
    audit(request, "let in phone", f"{found.name} at {found.address}, {given.role}")
    return Approved(name=found.name, address=found.address)


def _with_login(server: Server) -> None:
    if not server.access.login:
        raise Conflict("this server listens to this computer only; start it with --lan for phones")


def _signed_out(request: Request) -> None:
    """A link must not make somebody who is signed in somebody else."""
    if request.scope["state"].get("session") is not None:
        raise Refused("this browser is signed in already")


def _note_failure(request: Request, server: Server, why: str) -> None:
    log = server.access.log
    log.add("nobody", address(request), action="pair phone", what=why, outcome="failed")


def _hosts(request: Request) -> list[str]:
    """Names under which a phone finds this computer, the likeliest first."""
    asked = request.url.hostname or ""
    own = sorted(one for one in own_addresses() if not ipaddress.ip_address(one).is_loopback)
    if asked in LOOPBACK or asked.startswith("127."):
        return own or [asked]
    return [asked, *(one for one in own if one != asked)]


def _link(host: str, request: Request, token: str) -> PairingLink:
    port = urlsplit(f"//{request.headers['host']}").port
    name = f"[{host}]" if ":" in host else host
    url = f"{request.url.scheme}://{name}{f':{port}' if port else ''}/pair#{token}"
    code = segno.make_qr(url, error="m")
    return PairingLink(host=host, url=url, qr=code.svg_data_uri(scale=8, dark="#000", light="#fff"))
