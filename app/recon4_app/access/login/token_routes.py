"""HTTP route of access tokens: a person lets a program act, with a role and until a day.

A token is a session of a program. It is listed and revoked with the other sessions of the person,
and ends with them: a new password, another role and a disabled account revoke all tokens.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, Depends, Request
from pydantic import Field

from recon4.locales.coded import CodedText
from recon4_app.access.audit import address, audit
from recon4_app.access.login.routes import Wire
from recon4_app.access.people import (
    MAY,
    Permission,
    Role,
    Who,
    interactive_login,
    needs,
    recent_login,
)
from recon4_app.access.tuning import ACCESS_TOKEN
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.errors import Conflict, Refused
from recon4_app.names import Name

TOKEN_ROLES = (Role.VIEWER, Role.OPERATOR, Role.REVIEWER)
"""A program never administers; the first one is the usual one."""

router = APIRouter(
    prefix="/api/me/tokens",
    tags=["access"],
    dependencies=[
        Depends(needs(Permission.LOOK)),
        Depends(interactive_login),
        Depends(recent_login),
    ],
    responses=problems(401, 403, 409, 429),
)


class NewAccessToken(Wire):
    """A token to make."""

    label: Annotated[Name, Field(min_length=1, max_length=ACCESS_TOKEN.longest_label)]
    """For which program it is."""
    role: Role = Role.VIEWER
    """What the program may do; never more than the person."""
    days: Annotated[int, Field(ge=1, le=ACCESS_TOKEN.max_days)] = ACCESS_TOKEN.usual_days
    """When it expires, in days from now."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AccessTokenView:
    """A token that was just made: it is stored nowhere, and shown this once."""

    token: str


@router.post("", status_code=201, summary="Make an access token")
def make_access_token(
    new: NewAccessToken, request: Request, who: Who, *, server: Server
) -> AccessTokenView:
    """A program sends it as ``Authorization: Bearer TOKEN``, to ``/mcp`` and to the API."""
    if not server.access.login:
        raise Conflict(CodedText("no-login", name=who.name))
    if new.role not in TOKEN_ROLES or not MAY[new.role] <= MAY[who.role]:
        detail = CodedText("token-role", name=who.name, own=str(who.role), role=str(new.role))
        raise Refused(detail)
    token = server.access.sessions.issue(
        who.name, new.role, label=new.label, days=new.days, address=address(request)
    )
    audit(request, "make access token", f"{new.label}: {new.role}, {new.days} days")
    return AccessTokenView(token=token)
