"""The person behind a request: role and permissions."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from recon4.locales.coded import CodedText
from recon4_app.access.audit import AuditLog, audit
from recon4_app.access.tuning import PEOPLE_TIMES
from recon4_app.errors import LOGIN, Refused, SignInAgain


class Permission(StrEnum):
    """What a route requires; deny by default: every route names one."""

    SHARED = "shared"
    """See what a guest link shows: map, slices and report of one project."""
    LOOK = "look"
    """See projects, maps, reports; measure and cut slices."""
    REVIEW = "review"
    """Decide loop closures, approve."""
    PROCESS = "process"
    """Upload recordings, start and stop jobs."""
    CAPTURE = "capture"
    """Start and stop live captures."""
    SHARE = "share"
    """Make and revoke guest links."""
    ADMINISTER = "administer"
    """People, sessions, audit log."""


class Role(StrEnum):
    """Role of a person on this server."""

    NOBODY = "nobody"
    """Not signed in; never assigned to an account."""
    GUEST = "guest"
    """Came by a guest link to one project; never assigned to an account."""
    VIEWER = "viewer"
    OPERATOR = "operator"
    REVIEWER = "reviewer"
    ADMIN = "admin"


_LOOKS = frozenset({Permission.SHARED, Permission.LOOK})
MAY: dict[Role, frozenset[Permission]] = {
    Role.NOBODY: frozenset(),
    Role.GUEST: frozenset({Permission.SHARED}),
    Role.VIEWER: _LOOKS,
    Role.OPERATOR: _LOOKS | {Permission.PROCESS, Permission.CAPTURE},
    Role.REVIEWER: _LOOKS | {Permission.PROCESS, Permission.REVIEW, Permission.SHARE},
    Role.ADMIN: frozenset(Permission),
}
ASSIGNABLE = tuple(role for role in Role if role not in (Role.NOBODY, Role.GUEST))
"""Roles that an account can have."""


@dataclass(frozen=True, slots=True)
class Person:
    """The person behind a request."""

    name: str
    role: Role
    project: str = ""
    """The only project that a guest may see; empty = all."""

    def may(self, what: Permission) -> bool:
        """Whether the role of this person has a permission."""
        return what in MAY[self.role]


LOCAL = Person("local", Role.ADMIN)
"""The person at this computer, when the server listens on loopback only."""
READER = Person("local", Role.VIEWER)
"""The same person, when the folder of the projects cannot be written."""
NOBODY = Person("nobody", Role.NOBODY)
"""A caller who has not signed in."""


def person(connection: HTTPConnection) -> Person:
    """The person behind a request, as `SessionMiddleware` determined it."""
    found: Person = connection.scope["state"]["person"]
    return found


def signed_in_s(connection: HTTPConnection) -> float:
    """Seconds since this person last gave the password; 0 where there is no login."""
    found: float = connection.scope["state"]["signed_in_s"]
    return found


SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})
"""Of requests that change nothing."""

Who = Annotated[Person, Depends(person)]


def needs(what: Permission) -> Callable[[HTTPConnection], Awaitable[Person]]:
    """A dependency that requires a permission: ``dependencies=[Depends(needs(Permission.LOOK))]``.

    Raises (when called by the framework):
        Refused: If the person lacks the permission; the audit log gets an entry.
        NoRoom: If the request changes something and the disk is too full for that entry.
    """

    async def check(connection: HTTPConnection) -> Person:
        who = person(connection)
        log: AuditLog = connection.app.state.parts.access.log
        if not who.may(what):
            path = connection.scope["path"]
            await asyncio.to_thread(audit, connection, what, path, outcome="refused")
            if who is READER:
                raise Refused(CodedText("root-read-only"))
            if who.project:
                raise Refused(CodedText("guest-one-project"))
            raise Refused(
                CodedText("not-allowed", name=who.name, role=str(who.role), what=str(what))
            )
        if who.project and connection.path_params.get("project_id", who.project) != who.project:
            path = connection.scope["path"]
            await asyncio.to_thread(audit, connection, what, path, outcome="refused")
            raise Refused(CodedText("guest-one-project"))
        if connection.scope.get("method", "GET") not in SAFE_METHODS:
            await asyncio.to_thread(log.require_room)
        return who

    check.needs = what  # type: ignore[attr-defined]  # read by `recon4_app.access.routes_check`
    return check


def allow_anonymous() -> None:
    """The dependency of the few routes without login: ``Depends(allow_anonymous)``."""


def interactive_login(connection: HTTPConnection) -> Person:
    """A dependency that rejects phones and programs, as for ending their owner's sessions.

    Raises:
        Refused: If the session is that of a paired phone, or of a program.
    """
    session = connection.scope["state"].get("session")
    if session is not None and session.access_token:
        raise Refused(CodedText("token-may-not"))
    if session is not None and session.phone:
        raise Refused(CodedText("phone-may-not"), remedy=LOGIN)
    return person(connection)


def recent_login(connection: HTTPConnection) -> Person:
    """A dependency for what is signed with one's name: requires a recent password.

    Raises:
        SignInAgain: If that is more than `PEOPLE_TIMES.recent_login_s` ago:
            ``POST /api/login/again``.
    """
    if signed_in_s(connection) > PEOPLE_TIMES.recent_login_s:
        raise SignInAgain(CodedText("password-needed-again"))
    return person(connection)
