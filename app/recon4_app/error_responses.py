"""The one place where errors become HTTP, in the language of who reads them.

An `AppError` has a status of its own. A `Recon4Error` of the library means wrong input: 422. Errors
of the framework (fields of the wrong type, unknown paths) get a response of the same form.
"""

from __future__ import annotations

import html
import logging
import secrets
from collections.abc import Mapping
from http import HTTPStatus
from typing import NotRequired, TypedDict
from urllib.parse import quote

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import HTMLResponse, JSONResponse, Response
from pydantic import BaseModel
from sqlalchemy.exc import OperationalError
from starlette.exceptions import HTTPException

from recon4.errors import NoSpace, Recon4Error, UnknownFormat, WrongSettings
from recon4.locales.coded import CodedText, all_said, as_coded, coded, stored_text
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import Shown, texts
from recon4.store.atomic import is_full
from recon4_app.access.people import MAY, Person
from recon4_app.errors import STORAGE, AppError, NoRoom, Remedy, RemedyLink
from recon4_app.network.behind import prefix_of, route_path
from recon4_app.pages import SHARED_TEXTS, language_of, page_response

log = logging.getLogger(__name__)

LOST = "shared/lost.html"
"""The error page of browsers; `_page` fills in its places."""
TITLES = {403: "lost-not-allowed", 404: "lost-not-found"}
"""Of the error page, by status: names of texts."""
FRAMEWORK_CODES: Mapping[int, str] = {404: "address-unknown", 405: "method-not-allowed"}
"""Of errors of the framework, by status: codes of texts."""
HEADERS_OF_FAILURES = {
    "Content-Security-Policy": "default-src 'self'; frame-ancestors 'self'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-store",
}
"""Headers of the response to an internal error, which the framework sends past the middleware."""


class FieldProblem(TypedDict):
    """What is wrong with a field of a request, as pydantic says it."""

    loc: tuple[int | str, ...]
    msg: str
    """In English."""
    type: str
    ctx: NotRequired[dict[str, Shown | Exception]]
    """What the message quotes, or the error of a rule of our own."""


class ProblemDetail(BaseModel):
    """The response body of every error."""

    error: str
    """Name of the error."""
    detail: str
    """What is wrong and what to do, as text for users: in the language of `Accept-Language`, or as
    chosen on a page; without either in English."""
    code: str
    """What is wrong, the same in every language."""
    values: dict[str, bool | int | float | str] = {}
    """What `detail` quotes, by name."""
    problems: dict[str, str] = {}
    """Field -> its problem, where several fields have one."""
    candidates: list[str] = []
    """Paths of recordings in a folder that is none itself: one of them may be meant."""
    remedy: RemedyLink | None = None
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
            return _page(request, error.status, coded(error), headers=error.headers)
        problem = _problem_of(request, type(error).__name__, coded(error))
        problem.remedy = _permitted(error.remedy, request)
        return _problem(error.status, problem, error.headers)

    @app.exception_handler(Recon4Error)
    async def wrong_input(request: Request, error: Recon4Error) -> JSONResponse:
        problem = _input_problem(request, error)
        if isinstance(error, NoSpace):
            problem.remedy = _permitted(STORAGE, request)
        return _problem(422, problem)

    @app.exception_handler(RequestValidationError)
    async def wrong_form(request: Request, error: RequestValidationError) -> JSONResponse:
        language = language_of(request)
        detail = "; ".join(field_message(one, language) for one in error.errors())
        return _problem(422, ProblemDetail(error="Invalid", detail=detail, code="invalid"))

    @app.exception_handler(HTTPException)
    async def refused(request: Request, error: HTTPException) -> Response:
        status = HTTPStatus(error.status_code)
        code = FRAMEWORK_CODES.get(status)
        message = CodedText(code) if code else as_coded(str(error.detail))
        if _wants_page(request):
            return _page(request, status, message, headers=error.headers)
        name = status.phrase.title().replace(" ", "")
        return _problem(status, _problem_of(request, name, message), error.headers)

    @app.exception_handler(Exception)
    async def our_own(request: Request, error: Exception) -> Response:
        number = secrets.token_hex(4)
        log.error("error %s in %r", number, request.scope["path"], exc_info=error)
        message = CodedText("internal-error", number=number)
        if _wants_page(request):
            return _page(request, 500, message, headers=HEADERS_OF_FAILURES)
        problem = _problem_of(request, "InternalError", message)
        return _problem(500, problem, HEADERS_OF_FAILURES)


def _on_full_disk(app: FastAPI) -> None:
    """Answer 507 wherever a request fails because the disk is full."""

    @app.exception_handler(OperationalError)
    @app.exception_handler(OSError)
    async def full_disk(request: Request, error: Exception) -> Response:
        if not is_full(error):
            raise error
        log.error("the disk is full: %r failed: %s", request.scope["path"], error)
        full = CodedText("disk-is-full")
        problem = _problem_of(request, NoRoom.__name__, full)
        problem.remedy = _permitted(NoRoom.remedy, request)
        if _wants_page(request):
            return _page(request, NoRoom.status, full, headers=None)
        return _problem(NoRoom.status, problem)


def _problem_of(request: Request, error: str, text: CodedText) -> ProblemDetail:
    language = language_of(request)
    values = text.said_values(language)
    return ProblemDetail(error=error, detail=text.said(language), code=text.code, values=values)


def _input_problem(request: Request, error: Recon4Error) -> ProblemDetail:
    problem = _problem_of(request, type(error).__name__, coded(error))
    if isinstance(error, WrongSettings):
        problem.problems = all_said(error.problems, language_of(request))
    elif isinstance(error, UnknownFormat):
        problem.candidates = [str(path) for path in error.candidates]
    return problem


def _permitted(remedy: Remedy | None, request: Request) -> RemedyLink | None:
    """The remedy if the person behind the request may open its page."""
    if remedy is None:
        return None
    who: Person | None = request.scope.get("state", {}).get("person")
    if remedy.needs and (who is None or remedy.needs not in MAY[who.role]):
        return None
    return remedy.link(language_of(request))


def field_message(problem: FieldProblem, language: str) -> str:
    """Message about one field: ``recordings: List should have at least 1 item``.

    Args:
        problem: As pydantic describes it; its messages are in English.
        language: The language of the person.
    """
    place = problem["loc"]
    named = ".".join(map(str, place[1:])) or str(place[0])
    return f"{named}: {problem['msg'] if language == ENGLISH else _said(problem, language)}"


def _said(problem: FieldProblem, language: str) -> str:
    given = problem.get("ctx", {})
    ours = given.get("error")
    if isinstance(ours, Exception):
        return coded(ours).said(language)
    values = {name: value for name, value in given.items() if not isinstance(value, Exception)}
    text = stored_text(f"field-{problem['type']}", values, problem["msg"])
    return as_coded(text).said(language)


def _wants_page(request: Request) -> bool:
    """Whether a browser requests a page."""
    accepts = "text/html" in request.headers.get("accept", "")
    return request.method == "GET" and accepts and not route_path(request.scope).startswith("/api/")


def _page(
    request: Request, status: int, detail: CodedText, *, headers: Mapping[str, str] | None
) -> HTMLResponse:
    language = language_of(request)
    say = texts(language, SHARED_TEXTS)
    way, text = _way_on(request)
    fills = {
        "title": say(TITLES.get(status, "lost-failed")),
        "detail": html.escape(detail.said(language)),
        "way": html.escape(way),
        "way-text": say(text),
    }
    page = page_response(LOST, request, fills)
    page.status_code = status
    page.headers.update(headers or {})
    return page


def _way_on(request: Request) -> tuple[str, str]:
    """Where a person goes from the error page: address, name of its text.

    A guest may open one map, and not the list of projects.
    """
    who: Person | None = request.scope.get("state", {}).get("person")
    guest = who is not None and who.project
    path = f"/projects/{quote(who.project, safe='')}/map/" if who and guest else "/"
    return prefix_of(request.scope) + path, "shared-map-open" if guest else "all-projects"


def _problem(
    status: int, problem: ProblemDetail, headers: Mapping[str, str] | None = None
) -> JSONResponse:
    return JSONResponse(
        problem.model_dump(exclude_defaults=True), status_code=status, headers=headers
    )
