"""Errors of the server, and the one place where errors become HTTP.

    AppError
    ├── WeakPassword         422  a password that is guessed first
    ├── NotFound             404  no such project, job or file
    ├── Conflict             409  not possible in the present state
    │   └── IllegalTransition     a job cannot go from its state to that one
    ├── Unknown              401  nobody is signed in
    │   ├── WrongPassword         name and password do not fit
    │   └── SignInAgain           the password must be given once more
    ├── Refused              403  outside of what the server or this person may touch
    ├── TooMany              429  too often, or too much at a time
    ├── BadRequest           400  the request makes no sense
    ├── TooLarge             413  more bytes than the server takes
    ├── NoRoom               507  the disk has no room for it
    ├── ViewerFailed         503  the 3-D viewer does not start
    └── DeskFailed           503  a helper process died or took too long

A `Recon4Error` of the library is the fault of the input: 422.
"""

from __future__ import annotations

import logging
import math
import secrets
from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar

from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse
from pydantic import BaseModel

from recon4.errors import Recon4Error, WrongSettings

log = logging.getLogger(__name__)


class AppError(Exception):
    """Base of the tree above; the message is fit to be shown."""

    status: ClassVar[int] = 500
    headers: Mapping[str, str] = MappingProxyType({})
    """Sent with the answer."""


class WeakPassword(AppError):
    """A password that is guessed first."""

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
    """Nobody is signed in."""

    status = 401


class WrongPassword(Unknown):
    """Name and password do not fit."""


class SignInAgain(Unknown):
    """The password must be given once more."""


class Refused(AppError):
    """Outside of what the server or this person may touch."""

    status = 403


class TooMany(AppError):
    """Too often, or too much at a time; may say when it can be tried again."""

    status = 429

    def __init__(self, message: str, *, retry_after_s: float = 0.0) -> None:
        super().__init__(message)
        if retry_after_s:
            self.headers = {"Retry-After": str(math.ceil(retry_after_s))}


class BadRequest(AppError):
    """The request makes no sense."""

    status = 400


class TooLarge(AppError):
    """More bytes than the server takes."""

    status = 413


class NoRoom(AppError):
    """The disk has no room for it."""

    status = 507


class ViewerFailed(AppError):
    """The 3-D viewer does not start."""

    status = 503


class DeskFailed(AppError):
    """A helper process died or took too long."""

    status = 503


class Problem(BaseModel):
    """What every error answers."""

    error: str
    """Name of the error."""
    detail: str
    """What is wrong and what to do, for people."""
    problems: dict[str, str] = {}
    """Field -> what is wrong with it, when several fields are."""


def install(app: FastAPI) -> None:
    """Answer every error as a `Problem`."""

    @app.exception_handler(AppError)
    async def known(_: Request, error: AppError) -> JSONResponse:
        return _problem(error.status, type(error).__name__, str(error), headers=error.headers)

    @app.exception_handler(WrongSettings)
    async def wrong_settings(_: Request, error: WrongSettings) -> JSONResponse:
        return _problem(422, type(error).__name__, str(error), problems=error.problems)

    @app.exception_handler(Recon4Error)
    async def wrong_input(_: Request, error: Recon4Error) -> JSONResponse:
        return _problem(422, type(error).__name__, str(error))

    @app.exception_handler(Exception)
    async def our_own(request: Request, error: Exception) -> JSONResponse:
        number = secrets.token_hex(4)
        log.error("error %s in %r", number, request.scope["path"], exc_info=error)
        return _problem(500, "InternalError", f"the server failed; the log says why under {number}")


def _problem(
    status: int,
    error: str,
    detail: str,
    *,
    headers: Mapping[str, str] | None = None,
    problems: Mapping[str, str] | None = None,
) -> JSONResponse:
    problem = Problem(error=error, detail=detail, problems=dict(problems or {}))
    return JSONResponse(
        problem.model_dump(exclude_defaults=True), status_code=status, headers=headers
    )
