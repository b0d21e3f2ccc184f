"""HTTP route of the metrics, and the token with which a program reads them."""

from __future__ import annotations

import hmac
import re
import secrets
from pathlib import Path

from fastapi import APIRouter, Depends
from prometheus_client import CONTENT_TYPE_LATEST
from starlette.requests import Request
from starlette.responses import Response

from recon4.locales.coded import CodedText
from recon4.store.atomic import write_private
from recon4_app.access.people import NOBODY, Permission, Person, allow_anonymous, person
from recon4_app.errors import Refused, Unknown
from recon4_app.metrics import Metrics
from recon4_app.tuning import METRICS_TOKEN

TOKEN_FILE = "metrics.token"
TOKEN = re.compile(r"[A-Za-z0-9_-]{43}")
"""Of that many bytes."""

router = APIRouter()


def make_metrics_token(state: Path, *, renew: bool = False) -> str:
    """The token for ``/metrics``, created if there is none yet, or it is damaged.

    Args:
        state: Folder of the server's own files; exists.
        renew: Replace the one there is.
    """
    path = state / TOKEN_FILE
    if renew or not _read_token(path):
        token = secrets.token_urlsafe(METRICS_TOKEN.token_bytes)
        write_private(path, f"{token}\n".encode())
    return _read_token(path)


def may_read_metrics(request: Request) -> None:
    """A dependency that admits admins, and programs with the token.

    Raises (when called by the framework):
        Unknown: If the caller is not signed in and the token is missing or wrong.
        Refused: If the signed-in person is not an admin.
    """
    who: Person = person(request)
    if who.may(Permission.ADMINISTER) or _has_token(request):
        return
    if who == NOBODY:
        raise Unknown(CodedText("metrics-sign-in"))
    raise Refused(CodedText("metrics-not-allowed", name=who.name, role=str(who.role)))


@router.get(
    "/metrics",
    include_in_schema=False,
    dependencies=[Depends(allow_anonymous), Depends(may_read_metrics)],
)
def read_metrics(request: Request) -> Response:
    """All figures in Prometheus' text format."""
    metrics: Metrics = request.app.state.metrics
    return Response(metrics.text(), media_type=CONTENT_TYPE_LATEST)


def _has_token(request: Request) -> bool:
    scheme, _, given = request.headers.get("authorization", "").partition(" ")
    state: Path = request.app.state.parts.settings.state
    if scheme.lower() != "bearer" or not given:
        return False
    token = _read_token(state / TOKEN_FILE)
    return bool(token) and hmac.compare_digest(given.strip().encode(), token.encode())


def _read_token(path: Path) -> str:
    """The token in a file; empty = there is none, or it is cut or damaged: then nothing fits."""
    try:
        token = path.read_text("ascii").strip()
    except (OSError, UnicodeDecodeError):
        return ""
    return token if TOKEN.fullmatch(token) else ""
