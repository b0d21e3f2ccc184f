"""Letting a phone in without a password: a QR code on the laptop, or a code of six digits.

Two ways, both begun or confirmed by somebody who is signed in with a password. What the phone gets
is a session of that person with a role of its own, which may not be more than the person's.

- **Invitation**: a token of 128 random bits, shown as a QR code; for one phone, two minutes long.
- **Request**: the phone shows six digits and waits; somebody signed in types them where they are.
  The digits alone are worth nothing: the phone redeems a secret of its own, which nobody sees.

All of it is kept in memory and gone with the server; only hashes of tokens are kept.
"""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TypeVar

from app.access.audit import printable
from app.access.login.login_backoff import TokenBuckets, network
from app.access.login.sessions import hash_of
from app.access.people import MAY, Permission, Person, Role
from app.errors import NotFound, Refused, TooMany

INVITATION_S = 120.0
REQUEST_S = 300.0
MOST_OPEN = 20
"""Invitations, and requests, that wait at the same time …"""
MOST_OPEN_A_NETWORK = 4
"""… of which requests from one address: nobody fills the list alone."""
TRIES_A_MINUTE = 10
LONGEST_NAME = 64
PHONE_ROLES = (Role.OPERATOR, Role.VIEWER)
"""A phone never signs or administers."""

Open = TypeVar("Open", "Invitation", "PhoneRequest")


@dataclass(frozen=True, slots=True, kw_only=True)
class PairingGrant:
    """What a phone was allowed."""

    person: str
    """Who let it in."""
    role: Role


@dataclass(frozen=True, slots=True, kw_only=True)
class Invitation:
    """Shown as a QR code, for one phone."""

    grant: PairingGrant
    until_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PhoneRequest:
    """A phone that shows six digits and waits."""

    code: str
    name: str
    """What the phone calls itself."""
    address: str
    until_s: float
    grant: PairingGrant | None = None
    """What it was allowed; None = it waits."""


@dataclass(frozen=True, slots=True)
class PairingRequest:
    """What a phone gets that asks to be let in."""

    code: str
    """Six digits, to be shown."""
    token: str = field(repr=False)
    """To be redeemed, not to be shown."""


class Pairings:
    """All invitations and requests of a server; safe to call from any thread."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._invitations: dict[str, Invitation] = {}
        self._requests: dict[str, PhoneRequest] = {}
        self._tries = TokenBuckets(burst=TRIES_A_MINUTE, per_s=TRIES_A_MINUTE / 60, clock=clock)

    def invite(self, maker: Person, role: Role) -> str:
        """A one-time token for one phone; it is kept nowhere.

        Raises:
            Refused: If the phone would be allowed more than who invites it.
            TooMany: If too many invitations are open.
        """
        grant = grant_of(maker, role)
        token = secrets.token_urlsafe(16)
        with self._lock:
            _drop_old(self._invitations, self._clock())
            if len(self._invitations) >= MOST_OPEN:
                raise TooMany("too many invitations are open", retry_after_s=INVITATION_S)
            until_s = self._clock() + INVITATION_S
            self._invitations[hash_of(token)] = Invitation(grant=grant, until_s=until_s)
        return token

    def redeem(self, token: str, address: str) -> PairingGrant:
        """Use an invitation up.

        Raises:
            Refused: If it was used, is too old, or never was.
            TooMany: If there were too many tries from there.
        """
        self._try(("redeem", network(address)))
        with self._lock:
            _drop_old(self._invitations, self._clock())
            invitation = self._invitations.pop(hash_of(token), None)
        if invitation is None:
            raise Refused("this code was used already or is too old; make a new one")
        return invitation.grant

    def ask(self, name: str, address: str) -> PairingRequest:
        """A phone asks to be let in.

        Raises:
            Refused: If the name is too long.
            TooMany: If too many wait, or it asks too often.
        """
        if len(name) > LONGEST_NAME:
            raise Refused(f"the name of a phone has at most {LONGEST_NAME} characters")
        place = network(address)
        self._try(("ask", place))
        with self._lock:
            _drop_old(self._requests, self._clock())
            from_there = [r for r in self._requests.values() if network(r.address) == place]
            if len(self._requests) >= MOST_OPEN or len(from_there) >= MOST_OPEN_A_NETWORK:
                raise TooMany("too many phones wait to be let in", retry_after_s=REQUEST_S)
            taken = {request.code for request in self._requests.values()}
            code = _code(taken)
            token = secrets.token_urlsafe(16)
            self._requests[hash_of(token)] = PhoneRequest(
                code=code,
                name=printable(name.strip()) or "phone",
                address=address,
                until_s=self._clock() + REQUEST_S,
            )
        return PairingRequest(code, token)

    def approve(self, code: str, maker: Person, role: Role) -> PhoneRequest:
        """Let the phone in that shows a code.

        Raises:
            Refused: If it would be allowed more than who lets it in.
            NotFound: If no phone shows that code.
            TooMany: If there were too many tries.
        """
        grant = grant_of(maker, role)
        self._try(("approve", maker.name))
        with self._lock:
            _drop_old(self._requests, self._clock())
            for key, request in self._requests.items():
                if secrets.compare_digest(request.code, code) and request.grant is None:
                    self._requests[key] = replace(request, grant=grant)
                    return self._requests[key]
        raise NotFound("no phone shows that code now; they are good for five minutes")

    def claim(self, token: str) -> PairingGrant | None:
        """What a phone was allowed that asked, once; None = it still waits.

        Raises:
            Refused: If it never asked, waited too long, or was let in already.
        """
        key = hash_of(token)
        with self._lock:
            _drop_old(self._requests, self._clock())
            request = self._requests.get(key)
            if request is None:
                raise Refused("nobody let this phone in within five minutes; ask again")
            if request.grant is not None:
                del self._requests[key]
            return request.grant

    def _try(self, key: tuple[str, str]) -> None:
        if wait_s := self._tries.take(key):
            raise TooMany("too many tries; wait a moment", retry_after_s=wait_s)


def roles_for(maker: Person) -> list[Role]:
    """What phones a person may let in."""
    return [
        role for role in PHONE_ROLES if maker.may(Permission.LOOK) and MAY[role] <= MAY[maker.role]
    ]


def grant_of(maker: Person, role: Role) -> PairingGrant:
    """What a phone is allowed that a person lets in.

    Raises:
        Refused: If that is more than the person may, or no role of phones.
    """
    if role not in roles_for(maker):
        raise Refused(f"{maker.name} is a {maker.role} here and may not let in a phone as {role}")
    return PairingGrant(person=maker.name, role=role)


def _code(taken: set[str]) -> str:
    code = f"{secrets.randbelow(1_000_000):06d}"
    while code in taken:
        code = f"{secrets.randbelow(1_000_000):06d}"
    return code


def _drop_old(waiting: dict[str, Open], now_s: float) -> None:
    for key in [key for key, one in waiting.items() if one.until_s < now_s]:
        del waiting[key]
