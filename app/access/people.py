"""Who asks, and what that person may do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated

from fastapi import Depends
from starlette.requests import HTTPConnection

from app.errors import Refused


class May(StrEnum):
    """What a route needs; deny by default: every route names one."""

    LOOK = "look"
    """See projects, maps, reports; measure and cut slices."""
    REVIEW = "review"
    """Decide loop closures, approve."""
    PROCESS = "process"
    """Upload recordings, start and stop jobs."""
    CAPTURE = "capture"
    """Start and stop live captures."""
    ADMINISTER = "administer"
    """People, sessions, audit log."""


class Role(StrEnum):
    """What a person is on this server."""

    VIEWER = "viewer"
    OPERATOR = "operator"
    REVIEWER = "reviewer"
    ADMIN = "admin"


MAY: dict[Role, frozenset[May]] = {
    Role.VIEWER: frozenset({May.LOOK}),
    Role.OPERATOR: frozenset({May.LOOK, May.PROCESS, May.CAPTURE}),
    Role.REVIEWER: frozenset({May.LOOK, May.PROCESS, May.REVIEW}),
    Role.ADMIN: frozenset(May),
}


@dataclass(frozen=True, slots=True)
class Person:
    """Who asks."""

    name: str
    role: Role

    def may(self, what: May) -> bool:
        """Whether this person is allowed to."""
        return what in MAY[self.role]


def person(connection: HTTPConnection) -> Person:
    """Who asks, as the guard in front of the application found out."""
    found: Person = connection.scope["state"]["person"]
    return found


Who = Annotated[Person, Depends(person)]


def needs(what: May) -> Callable[[Person], Person]:
    """A dependency that lets only those pass who may: ``dependencies=[Depends(needs(May.LOOK))]``.

    Raises (when called by the framework):
        Refused: If the person may not.
    """

    def check(who: Who) -> Person:
        if not who.may(what):
            raise Refused(f"{who.name} is a {who.role} here and may not {what}; ask an admin")
        return who

    check.needs = what  # type: ignore[attr-defined]  # read by the test of the role matrix
    return check
