"""Pairing: signing in a phone without a password, with a QR code or a code of six digits.

Both ways are begun or confirmed by a person who is signed in with a password. The phone gets a
session of that person with a role of its own, which may not exceed the person's.

- **Invitation**: a token of 128 random bits, shown as a QR code; for one phone, two minutes long.
- **Request**: the phone shows six digits and waits; a signed-in person types them on the laptop.
  The digits alone are worth nothing: the phone redeems a secret of its own, which is not shown.

Everything is kept in memory and ends with the server; only hashes of tokens are kept.
"""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TypeVar

from recon4.locales.coded import CodedText
from recon4_app.access.audit import printable
from recon4_app.access.login.login_backoff import TokenBuckets, network
from recon4_app.access.login.sessions import hash_of
from recon4_app.access.people import MAY, Permission, Person, Role
from recon4_app.access.tuning import PAIRING
from recon4_app.errors import NotFound, Refused, TooMany

PHONE_ROLES = (Role.OPERATOR, Role.VIEWER)
"""A phone never signs or administers."""

Open = TypeVar("Open", "Invitation", "PhoneRequest")


@dataclass(frozen=True, slots=True, kw_only=True)
class PairingGrant:
    """The session a phone is granted."""

    person: str
    """The person who paired the phone."""
    role: Role


@dataclass(frozen=True, slots=True, kw_only=True)
class Invitation:
    """An invitation for one phone, shown as a QR code."""

    grant: PairingGrant
    until_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PhoneRequest:
    """A phone that shows six digits and waits."""

    code: str
    name: str
    """Name that the phone gave."""
    address: str
    until_s: float
    grant: PairingGrant | None = None
    """What it was granted; None = it waits."""


@dataclass(frozen=True, slots=True)
class PairingRequest:
    """The response to a phone that requests pairing."""

    code: str
    """Six digits that the phone shows."""
    token: str = field(repr=False)
    """Secret that the phone redeems and does not show."""


class Pairings:
    """All invitations and requests of a server; thread-safe."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._invitations: dict[str, Invitation] = {}
        self._requests: dict[str, PhoneRequest] = {}
        self._tries = TokenBuckets(
            burst=PAIRING.tries_a_minute, per_s=PAIRING.tries_a_minute / 60, clock=clock
        )

    def invite(self, maker: Person, role: Role) -> str:
        """A one-time token for one phone; it is stored nowhere.

        Raises:
            Refused: If the phone would be granted more than its inviter has.
            TooMany: If too many invitations are open.
        """
        grant = grant_of(maker, role)
        token = secrets.token_urlsafe(16)
        with self._lock:
            _drop_old(self._invitations, self._clock())
            if len(self._invitations) >= PAIRING.max_open:
                raise TooMany(CodedText("invitations-too-many"), retry_after_s=PAIRING.invitation_s)
            until_s = self._clock() + PAIRING.invitation_s
            self._invitations[hash_of(token)] = Invitation(grant=grant, until_s=until_s)
        return token

    def redeem(self, token: str, address: str) -> PairingGrant:
        """Redeem an invitation, once.

        Raises:
            Refused: If it was used, has expired, or never existed.
            TooMany: If there were too many attempts from that network.
        """
        self._try(("redeem", network(address)))
        with self._lock:
            _drop_old(self._invitations, self._clock())
            invitation = self._invitations.pop(hash_of(token), None)
        if invitation is None:
            raise Refused(CodedText("pairing-code-used"))
        return invitation.grant

    def request(self, name: str, address: str) -> PairingRequest:
        """Request pairing for a phone.

        Raises:
            Refused: If the name is too long.
            TooMany: If too many phones wait, or this one sends too many requests.
        """
        if len(name) > PAIRING.longest_name:
            raise Refused(CodedText("phone-name-long", limit=PAIRING.longest_name))
        place = network(address)
        self._try(("request", place))
        with self._lock:
            _drop_old(self._requests, self._clock())
            from_there = [r for r in self._requests.values() if network(r.address) == place]
            if (
                len(self._requests) >= PAIRING.max_open
                or len(from_there) >= PAIRING.max_open_a_network
            ):
                raise TooMany(CodedText("phones-too-many"), retry_after_s=PAIRING.request_s)
            taken = {request.code for request in self._requests.values()}
            code = _code(taken)
            token = secrets.token_urlsafe(16)
            self._requests[hash_of(token)] = PhoneRequest(
                code=code,
                name=printable(name.strip()) or "phone",
                address=address,
                until_s=self._clock() + PAIRING.request_s,
            )
        return PairingRequest(code, token)

    def approve(self, code: str, maker: Person, role: Role) -> PhoneRequest:
        """Approve the request of the phone that shows a code.

        Raises:
            Refused: If the phone would be granted more than its approver has.
            NotFound: If no phone shows that code.
            TooMany: If there were too many attempts.
        """
        grant = grant_of(maker, role)
        self._try(("approve", maker.name))
        with self._lock:
            _drop_old(self._requests, self._clock())
            for key, request in self._requests.items():
                if secrets.compare_digest(request.code, code) and request.grant is None:
                    self._requests[key] = replace(request, grant=grant)
                    return self._requests[key]
        raise NotFound(CodedText("phone-code-unknown"))

    def claim(self, token: str) -> PairingGrant | None:
        """What a waiting phone was granted, returned once; None = it still waits.

        Raises:
            Refused: If there is no such request, it has expired, or it was granted already.
        """
        key = hash_of(token)
        with self._lock:
            _drop_old(self._requests, self._clock())
            request = self._requests.get(key)
            if request is None:
                raise Refused(CodedText("phone-not-approved"))
            if request.grant is not None:
                del self._requests[key]
            return request.grant

    def _try(self, key: tuple[str, str]) -> None:
        if wait_s := self._tries.take(key):
            raise TooMany(CodedText("attempts-too-many"), retry_after_s=wait_s)


def roles_for(maker: Person) -> list[Role]:
    """Roles with which a person may pair phones."""
    return [
        role for role in PHONE_ROLES if maker.may(Permission.LOOK) and MAY[role] <= MAY[maker.role]
    ]


def grant_of(maker: Person, role: Role) -> PairingGrant:
    """The grant for a phone that a person pairs.

    Raises:
        Refused: If the role exceeds the person's, or is none for phones.
    """
    if role not in roles_for(maker):
        raise Refused(CodedText("phone-role", name=maker.name, own=str(maker.role), role=str(role)))
    return PairingGrant(person=maker.name, role=role)


def _code(taken: set[str]) -> str:
    code = f"{secrets.randbelow(1_000_000):06d}"
    while code in taken:
        code = f"{secrets.randbelow(1_000_000):06d}"
    return code


def _drop_old(waiting: dict[str, Open], now_s: float) -> None:
    for key in [key for key, one in waiting.items() if one.until_s < now_s]:
        del waiting[key]
