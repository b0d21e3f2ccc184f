"""HTTP routes of pairing: the laptop's side and the phone's."""

from __future__ import annotations

import ipaddress
from dataclasses import dataclass
from typing import Annotated
from urllib.parse import urlsplit

import segno
from fastapi import APIRouter, Depends, Request, Response
from pydantic import Field

from recon4.locales.coded import CodedText
from recon4_app.access.audit import address, audit
from recon4_app.access.login.routes import Me, Text, Wire, enter_paired
from recon4_app.access.pairing.pairings import PairingGrant, roles_for
from recon4_app.access.people import (
    Permission,
    Person,
    Role,
    Who,
    allow_anonymous,
    interactive_login,
    needs,
)
from recon4_app.access.tuning import PAIRING
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.errors import AppError, Conflict, Refused
from recon4_app.names import Name
from recon4_app.network.behind import public_path
from recon4_app.network.hosts import LOOPBACK, own_addresses
from recon4_app.network.listen import presented_fingerprint

router = APIRouter(
    prefix="/api/pairing",
    tags=["phones"],
    responses=problems(403, 409, 429),
)
ALLOW_ANONYMOUS = [Depends(allow_anonymous)]
MANAGE_PHONES = [Depends(needs(Permission.LOOK)), Depends(interactive_login)]


class NewInvitation(Wire):
    """Role for the phone."""

    role: Role


class Token(Wire):
    """Token that the phone was given."""

    token: Text


class NewRequest(Wire):
    """A phone that requests pairing."""

    name: Annotated[Name, Field(max_length=64)] = ""
    """Name of the phone."""


class PairingApproval(Wire):
    """The digits a phone shows, and the role for it."""

    code: Annotated[str, Field(pattern=r"^[0-9]{6}$")]
    role: Role


@dataclass(frozen=True, slots=True, kw_only=True)
class PairingView:
    """Pairing options of a person."""

    login: bool
    """Whether phones can be paired; else the server listens on this computer only."""
    roles: list[Role]
    """Roles with which this person may pair phones."""
    fingerprint: str
    """SHA-256 of the certificate, to compare on the phone."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PairingLink:
    """A URL by which the phone reaches this computer."""

    host: str
    url: str
    """With the one-time token in its fragment, which browsers send nowhere."""
    qr: str
    """QR code of the URL: an SVG image as data URI."""


@dataclass(frozen=True, slots=True, kw_only=True)
class InvitationView:
    """An invitation as the laptop shows it."""

    links: list[PairingLink]
    """One for each address of this computer, the likeliest first; all are the same invitation."""
    seconds: float
    """Time until it expires [s]."""
    role: Role


@dataclass(frozen=True, slots=True, kw_only=True)
class PairingRequestView:
    """The code that a phone shows, and the token that it keeps secret."""

    code: str
    token: str
    seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Approved:
    """The phone that was approved."""

    name: str
    address: str


@router.get("", dependencies=MANAGE_PHONES, summary="Pairing options")
def read_pairing(server: Server, who: Who) -> PairingView:
    """Roles this person may give to phones, and the fingerprint of the certificate."""
    fingerprint = presented_fingerprint(server.settings)
    return PairingView(
        login=server.access.login, roles=roles_for(who), fingerprint=fingerprint or ""
    )


@router.post(
    "/invitations", status_code=201, dependencies=MANAGE_PHONES, summary="Invite a phone (QR code)"
)
def invite(new: NewInvitation, request: Request, server: Server, *, who: Who) -> InvitationView:
    """Create a one-time link for one phone, valid for two minutes."""
    _with_login(server)
    token = server.access.pairings.invite(who, new.role)
    audit(request, "invite phone", new.role)
    behind = server.settings.behind
    hosts = [behind.host] if behind else _hosts(request, server.settings.host)
    links = [_link(host, request, token) for host in hosts]
    return InvitationView(links=links, seconds=PAIRING.invitation_s, role=new.role)


@router.post("/redeem", dependencies=ALLOW_ANONYMOUS, summary="Redeem an invitation")
def redeem(given: Token, request: Request, response: Response, *, server: Server) -> Me:
    """Redeem the token of a QR code; the response sets the session cookie of the phone."""
    _with_login(server)
    _signed_out(request)
    try:
        grant = server.access.pairings.redeem(given.token, address(request))
    except AppError as error:
        _note_failure(request, server, str(error))
        raise
    return enter_paired(server.access, request, response, grant=grant)


@router.post("/requests", status_code=201, dependencies=ALLOW_ANONYMOUS, summary="Request pairing")
def request_pairing(new: NewRequest, request: Request, server: Server) -> PairingRequestView:
    """Request pairing with six digits; a signed-in person types them at ``/phone``."""
    _with_login(server)
    _signed_out(request)
    pending = server.access.pairings.request(new.name, address(request))
    return PairingRequestView(code=pending.code, token=pending.token, seconds=PAIRING.request_s)


@router.post("/claim", dependencies=ALLOW_ANONYMOUS, summary="Claim a pairing")
def claim(given: Token, request: Request, response: Response, *, server: Server) -> Me | None:
    """Claim the session of a phone: null while it waits; once approved, sets the session cookie."""
    _with_login(server)
    _signed_out(request)
    grant: PairingGrant | None = server.access.pairings.claim(given.token)
    if grant is None:
        return None
    return enter_paired(server.access, request, response, grant=grant)


@router.post("/approve", dependencies=MANAGE_PHONES, summary="Approve a phone")
def approve(given: PairingApproval, request: Request, server: Server, *, who: Who) -> Approved:
    """Approve the phone that shows these digits; check that you see the phone."""
    _with_login(server)
    try:
        found = server.access.pairings.approve(given.code, Person(who.name, who.role), given.role)
    except AppError as error:
        audit(request, "approve phone", str(error), outcome="failed")
        raise
    audit(request, "approve phone", f"{found.name} at {found.address}, {given.role}")
    return Approved(name=found.name, address=found.address)


def _with_login(server: Server) -> None:
    if not server.access.login:
        raise Conflict(CodedText("phones-need-lan"))


def _signed_out(request: Request) -> None:
    """Reject a signed-in browser: a link must not sign it in as another person."""
    if request.scope["state"].get("session") is not None:
        raise Refused(CodedText("signed-in-already"))


def _note_failure(request: Request, server: Server, why: str) -> None:
    log = server.access.log
    log.add("nobody", address(request), action="pair phone", what=why, outcome="failed")


def _hosts(request: Request, listens_on: str) -> list[str]:
    """Host names under which a phone reaches this server, the likeliest first.

    Args:
        request: Its own host name reached the server.
        listens_on: Address of the server; ``0.0.0.0`` is each IPv4 address, ``::`` each address.
    """
    asked = request.url.hostname or ""
    addresses = map(ipaddress.ip_address, own_addresses())
    own = sorted(
        str(one) for one in addresses if not one.is_loopback and is_served(one, listens_on)
    )
    if asked in LOOPBACK or asked.startswith("127."):
        return own or [asked]
    return [asked, *(one for one in own if one != asked)]


def is_served(address: ipaddress.IPv4Address | ipaddress.IPv6Address, listens_on: str) -> bool:
    """Whether a server that listens on an address is reached at another one of this computer."""
    return listens_on in ("::", str(address)) or (listens_on == "0.0.0.0" and address.version == 4)


def _link(host: str, request: Request, token: str) -> PairingLink:
    port = urlsplit(f"//{request.headers['host']}").port
    name = f"[{host}]" if ":" in host else host
    path = public_path(request.scope, "/pair")
    url = f"{request.url.scheme}://{name}{f':{port}' if port else ''}{path}#{token}"
    code = segno.make_qr(url, error="m")
    return PairingLink(host=host, url=url, qr=code.svg_data_uri(scale=8, dark="#000", light="#fff"))
