"""The one place where errors become HTTP.

An `AppError` has a status of its own. A `Recon4Error` of the library means wrong input: 422. Errors
of the framework (fields of the wrong type, unknown paths) get a response of the same form.
"""

from __future__ import annotations

import html
import logging
import secrets
from collections.abc import Mapping, Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import HTMLResponse, JSONResponse, Response
from pydantic import BaseModel
from sqlalchemy.exc import OperationalError
from starlette.exceptions import HTTPException

from recon4.errors import NoSpace, Recon4Error, UnknownFormat, WrongSettings
from recon4.locales.texts import texts
from recon4.store.atomic import is_full
from recon4_app.access.people import MAY, Person
from recon4_app.errors import STORAGE, AppError, NoRoom, Remedy
from recon4_app.network.behind import route_path
from recon4_app.pages import SHARED_TEXTS, language_of, page_response

log = logging.getLogger(__name__)

LOST = "shared/lost.html"
"""The error page of browsers; ``{title}`` and ``{detail}`` are filled in."""
TITLES = {403: "lost-not-allowed", 404: "lost-not-found"}
"""Of the error page, by status: names of texts."""
FRAMEWORK_MESSAGES: Mapping[int, str] = {
    404: "there is no such address on this server",
    405: "this address does not take that method",
}
FULL = "the disk is full; make room and try again"
HEADERS_OF_FAILURES = {
    "Content-Security-Policy": "default-src 'self'; frame-ancestors 'self'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}
"""Headers of the response to an internal error, which the framework sends past the middleware."""


class ProblemDetail(BaseModel):
    """The response body of every error."""

    error: str
    """Name of the error."""
    detail: str
    """What is wrong and what to do, as text for users."""
    problems: dict[str, str] = {}
    """Field -> its problem, where several fields have one."""
    candidates: list[str] = []
    """Paths of recordings in a folder that is none itself: one of them may be meant."""
    remedy: Remedy | None = None
    """The page of this server where what `detail` advises is done, if it is another one."""


PROBLEM = {"application/json": {"schema": {"$ref": "#/components/schemas/ProblemDetail"}}}
"""The body of an error, in the description of the API; a model for each route takes longer."""


def problems(*statuses: int) -> dict[int | str, dict[str, object]]:
    """The errors that routes document, for their ``responses``."""
    return {status: {"content": PROBLEM} for status in statuses}


def install(app: FastAPI) -> None:
    """Answer every error with a `ProblemDetail`, or with a page where a browser requests one."""
    _on_full_disk(app)

    @app.exception_handler(AppError)
    async def known(request: Request, error: AppError) -> Response:
        if _wants_page(request):
            return _page(request, error.status, str(error), headers=error.headers)
        problem = ProblemDetail(error=type(error).__name__, detail=str(error))
        problem.remedy = _permitted(error.remedy, request)
        return _problem(error.status, problem, error.headers)

    @app.exception_handler(Recon4Error)
    async def wrong_input(request: Request, error: Recon4Error) -> JSONResponse:
        problem = _input_problem(error)
        if isinstance(error, NoSpace):
            problem.remedy = _permitted(STORAGE, request)
        return _problem(422, problem)

    @app.exception_handler(RequestValidationError)
    async def wrong_form(_: Request, error: RequestValidationError) -> JSONResponse:
        detail = "; ".join(_field_message(one) for one in error.errors())
        return _problem(422, ProblemDetail(error="Invalid", detail=detail))

    @app.exception_handler(HTTPException)
    async def refused(request: Request, error: HTTPException) -> Response:
        status = HTTPStatus(error.status_code)
        message = FRAMEWORK_MESSAGES.get(status, str(error.detail))
        if _wants_page(request):
            return _page(request, status, message, headers=error.headers)
        name = status.phrase.title().replace(" ", "")
        return _problem(status, ProblemDetail(error=name, detail=message), error.headers)

    @app.exception_handler(Exception)
    async def our_own(request: Request, error: Exception) -> Response:
        number = secrets.token_hex(4)
        log.error("error %s in %r", number, request.scope["path"], exc_info=error)
        message = f"internal error {number}: the server log has the cause under this number"
        if _wants_page(request):
            return _page(request, 500, message, headers=HEADERS_OF_FAILURES)
        problem = ProblemDetail(error="InternalError", detail=message)
        return _problem(500, problem, HEADERS_OF_FAILURES)


def _on_full_disk(app: FastAPI) -> None:
    """Answer 507 wherever a request fails because the disk is full."""

    @app.exception_handler(OperationalError)
    @app.exception_handler(OSError)
    async def full_disk(request: Request, error: Exception) -> Response:
        if not is_full(error):
            raise error
        log.error("the disk is full: %r failed: %s", request.scope["path"], error)
        problem = ProblemDetail(error=NoRoom.__name__, detail=FULL)
        problem.remedy = _permitted(NoRoom.remedy, request)
        if _wants_page(request):
            return _page(request, NoRoom.status, FULL, headers=None)
        return _problem(NoRoom.status, problem)


def _input_problem(error: Recon4Error) -> ProblemDetail:
    problem = ProblemDetail(error=type(error).__name__, detail=str(error))
    if isinstance(error, WrongSettings):
        problem.problems = error.problems
    elif isinstance(error, UnknownFormat):
        problem.candidates = [str(path) for path in error.candidates]
    return problem


def _permitted(remedy: Remedy | None, request: Request) -> Remedy | None:
    """The remedy if the person behind the request may open its page."""
    if remedy is None or not remedy.needs:
        return remedy
    who: Person | None = request.scope.get("state", {}).get("person")
    return remedy if who is not None and remedy.needs in MAY[who.role] else None


def _field_message(problem: Mapping[str, Any]) -> str:
    """Message about one field: ``recordings: List should have at least 1 item``."""
    place: Sequence[Any] = problem["loc"]
    named = ".".join(map(str, place[1:])) or str(place[0])
    return f"{named}: {problem['msg']}"


def _wants_page(request: Request) -> bool:
    """Whether a browser requests a page."""
    accepts = "text/html" in request.headers.get("accept", "")
    return request.method == "GET" and accepts and not route_path(request.scope).startswith("/api/")


def _page(
    request: Request, status: int, detail: str, *, headers: Mapping[str, str] | None
) -> HTMLResponse:
    say = texts(language_of(request), SHARED_TEXTS)
    fills = {"title": say(TITLES.get(status, "lost-failed")), "detail": html.escape(detail)}
    page = page_response(LOST, request, fills)
    page.status_code = status
    page.headers.update(headers or {})
    return page


def _problem(
    status: int, problem: ProblemDetail, headers: Mapping[str, str] | None = None
) -> JSONResponse:
    return JSONResponse(
        problem.model_dump(exclude_defaults=True), status_code=status, headers=headers
    )
