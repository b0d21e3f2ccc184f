"""Errors of the server; `recon4_app.error_responses` makes HTTP of them.

AppError
├── WeakPassword         422  a password that is too easy to find
├── NotFound             404  no such project, job or file
├── Conflict             409  not possible in the present state
│   └── IllegalTransition     a job cannot go from its state to that one
├── Unknown              401  not signed in
│   ├── WrongPassword         wrong name or password
│   └── SignInAgain           the password must be given again
├── Refused              403  not permitted for the server or this person
├── TooMany              429  too many requests, or too many at a time
├── BadRequest           400  the request is malformed
├── TooLarge             413  more bytes than the server accepts
├── NoRoom               507  not enough disk space
├── ViewerFailed         503  the 3-D viewer does not start
├── ComputeFailed        503  a helper process died or took too long
└── ClientLeft           499  the client disconnected; the response is discarded
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import ClassVar
from urllib.parse import quote

from recon4.locales.coded import CodedText


@dataclass(frozen=True, slots=True)
class RemedyLink:
    """A `Remedy` in the language of a person."""

    text: str
    """Text of the link."""
    page: str
    """Path of the page, below the address of this server."""
    needs: str = ""
    """Permission for that page; empty = none."""


@dataclass(frozen=True, slots=True)
class Remedy:
    """The page where the reader of an error does what its message names.

    Not needed where the page that shows the error has the field or button itself.
    """

    code: str
    """Code of the text of the link (`recon4.locales.coded`)."""
    page: str
    """Path of the page, below the address of this server."""
    needs: str = ""
    """Permission for that page; empty = none."""
    about: Mapping[str, str] = field(default_factory=dict)
    """What the text quotes."""

    def link(self, language: str) -> RemedyLink:
        """The link in a language."""
        text = CodedText(self.code, **self.about).said(language)
        return RemedyLink(text, self.page, self.needs)


STORAGE = Remedy("see-storage", "/storage", needs="process")
LOGIN = Remedy("see-login", "/login")
CAPTURE = Remedy("see-capture", "/live", needs="look")
PROJECTS = Remedy("see-jobs", "/", needs="look")


def project_page(project_id: str) -> Remedy:
    """The page of a project: its job, its name, its deletion."""
    page = f"/projects/{quote(project_id)}/"
    return Remedy("see-project", page, needs="look", about={"project": project_id})


class AppError(Exception):
    """Base of the tree above; the message is shown to users, in their language."""

    status: ClassVar[int] = 500
    headers: Mapping[str, str] = MappingProxyType({})
    """Headers of the response."""
    remedy: Remedy | None = None

    def __init__(self, message: CodedText, *, remedy: Remedy | None = None) -> None:
        super().__init__(message)
        self.remedy = remedy or self.remedy


class WeakPassword(AppError):
    """A password that is too easy to find."""

    status = 422


class NotFound(AppError):
    """There is no such thing."""

    status = 404


class Conflict(AppError):
    """Not possible in the present state."""

    status = 409


class IllegalTransition(Conflict):
    """A job cannot go from its state to that one."""


class Unknown(AppError):
    """Not signed in."""

    status = 401


class WrongPassword(Unknown):
    """Name and password do not fit."""


class SignInAgain(Unknown):
    """The password must be given again."""


class Refused(AppError):
    """Not permitted for the server or this person."""

    status = 403


class TooMany(AppError):
    """Too many requests, or too many at a time; may carry the time to wait."""

    status = 429

    def __init__(
        self, message: CodedText, *, retry_after_s: float = 0.0, remedy: Remedy | None = None
    ) -> None:
        super().__init__(message, remedy=remedy)
        if retry_after_s:
            self.headers = {"Retry-After": str(math.ceil(retry_after_s))}


class BadRequest(AppError):
    """The request is malformed."""

    status = 400


class TooLarge(AppError):
    """More bytes than the server accepts."""

    status = 413


class NoRoom(AppError):
    """Not enough disk space."""

    status = 507
    remedy = STORAGE


class ViewerFailed(AppError):
    """The 3-D viewer does not start."""

    status = 503


class ComputeFailed(AppError):
    """A helper process died or took too long."""

    status = 503


class ClientLeft(AppError):
    """The client disconnected; the response is discarded."""

    status = 499
