"""HTTP routes of the login and of one's own account."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, Depends, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from recon4.locales.coded import CodedText
from recon4_app.access.audit import address, audit
from recon4_app.access.guests.guest_links import GuestEntry
from recon4_app.access.login.login_service import Access, LoginOrigin, LoginResult
from recon4_app.access.login.sessions import LIVES, PHONE_LIFE, Session, form_token
from recon4_app.access.middleware.session import CookieNames, cookie, cookie_names
from recon4_app.access.pairing.pairings import PairingGrant
from recon4_app.access.people import (
    LOCAL,
    MAY,
    Permission,
    Role,
    Who,
    allow_anonymous,
    interactive_login,
    needs,
)
from recon4_app.access.tuning import SESSION_TIMES
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.errors import AppError, Conflict, TooMany
from recon4_app.network.behind import prefix_of

router = APIRouter(
    prefix="/api",
    tags=["access"],
    responses=problems(401, 403, 429),
)
ALLOW_ANONYMOUS = Depends(allow_anonymous)
SIGNED_IN = Depends(needs(Permission.LOOK))
"""Every signed-in person may look."""
WITH_SESSION = Depends(needs(Permission.SHARED))
"""Guests, too."""
INTERACTIVE = Depends(interactive_login)
"""Rejects paired phones and programs."""

Text = Annotated[str, Field(max_length=1000)]


class Wire(BaseModel):
    """Base of request bodies; unknown fields are rejected."""

    model_config = ConfigDict(extra="forbid")


class Credentials(Wire):
    """Name and password."""

    name: Text
    password: Text


class FirstAdmin(Credentials):
    """Name and password of the first admin, with the setup token."""

    token: Text
    """From the link the server showed at its start."""


class PasswordConfirmation(Wire):
    """The current password, given again."""

    password: Text


class NewPassword(Wire):
    """The old and the new password."""

    old: Text
    new: Text


@dataclass(frozen=True, slots=True, kw_only=True)
class Me:
    """The signed-in person."""

    name: str
    role: Role
    may: tuple[Permission, ...]
    """Permissions of the role."""
    login: bool
    """Whether people sign in to this server."""
    token: str
    """Value of the header ``X-Recon4-Token`` of every request that changes state."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SessionView:
    """A session in a list of sessions."""

    session: Session
    current: bool
    """Whether it is the session of this request."""


@router.post("/login", dependencies=[ALLOW_ANONYMOUS])
def login(given: Credentials, request: Request, response: Response, *, server: Server) -> Me:
    """Sign in; the response sets the session cookie."""
    access = _with_login(server.access)
    try:
        result = access.logins.sign_in(given.name, given.password, _caller(request))
    except AppError as error:
        _note_failure(access, request, given.name, error=error)
        raise
    return _start_session(access, request, response, result=result)


@router.post("/setup", dependencies=[ALLOW_ANONYMOUS])
def set_up(given: FirstAdmin, request: Request, response: Response, *, server: Server) -> Me:
    """Create the first admin with the one-time token that the server showed at its start."""
    access = _with_login(server.access)
    result = access.logins.set_up(
        given.token, given.name, password=given.password, caller=_caller(request)
    )
    name = result.account.name
    access.log.add(name, address(request), action="set up", what=f"{name}, admin")
    return _start_session(access, request, response, result=result)


@router.post("/login/again", dependencies=[SIGNED_IN, INTERACTIVE])
def login_again(
    given: PasswordConfirmation, request: Request, response: Response, *, server: Server
) -> Me:
    """Confirm the password again, as approval requires; the session cookie changes."""
    access = _with_login(server.access)
    session: Session = request.scope["state"]["session"]
    try:
        access.logins.prove(session.person, given.password, _caller(request))
    except AppError as error:
        _note_failure(access, request, session.person, error=error)
        raise
    token = access.sessions.prove(session.id)
    _set_cookie(request, response, token, lasts_s=LIVES[session.role].whole_s)
    audit(request, "sign in again", session.id)
    return _me(access, session.person, role=session.role, token=token)


@router.post("/logout", status_code=204, dependencies=[WITH_SESSION])
def logout(request: Request, response: Response, server: Server) -> None:
    """Sign out: end this session; its open streams and WebSockets close."""
    access = _with_login(server.access)
    session: Session = request.scope["state"]["session"]
    access.sessions.end(session.id)
    audit(request, "sign out", session.id)
    names = _cookies(request)
    response.delete_cookie(
        names.session, path=names.path, secure=True, httponly=True, samesite="strict"
    )
    if not prefix_of(request.scope):  # it is about a whole host; the pages clear what they keep
        response.headers["Clear-Site-Data"] = '"cache", "storage"'


@router.get("/me", dependencies=[WITH_SESSION])
def read_me(request: Request, who: Who, server: Server) -> Me:
    """The signed-in person, the person's permissions, and the token for changes."""
    token = cookie(request.scope, _cookies(request).session) if server.access.login else ""
    return _me(server.access, who.name, role=who.role, token=token)


@router.post("/me/password", dependencies=[SIGNED_IN, INTERACTIVE])
def change_password(
    given: NewPassword, request: Request, response: Response, *, server: Server
) -> Me:
    """Change one's own password; all other sessions end."""
    access = _with_login(server.access)
    name = request.scope["state"]["session"].person
    caller = _caller(request)
    access.logins.prove(name, given.old, caller)
    access.accounts.set_password(name, given.new)
    access.sessions.forget_cached()
    audit(request, "change password", name)
    result = access.logins.sign_in(name, given.new, caller)
    return _start_session(access, request, response, result=result)


@router.get("/me/sessions", dependencies=[SIGNED_IN, INTERACTIVE])
def list_my_sessions(request: Request, who: Who, server: Server) -> list[SessionView]:
    """List one's own sessions."""
    return views(request, server.access.sessions.all(person=who.name))


@router.delete("/me/sessions/{session_id}", status_code=204, dependencies=[SIGNED_IN, INTERACTIVE])
def end_my_session(session_id: str, request: Request, who: Who, *, server: Server) -> None:
    """End one of one's own sessions."""
    server.access.sessions.end(session_id, person=who.name)
    audit(request, "end session", f"{session_id} of {who.name}")


def views(request: Request, sessions: list[Session]) -> list[SessionView]:
    """Views of sessions; marks the one of this request."""
    mine: Session | None = request.scope["state"].get("session")
    return [SessionView(session=one, current=bool(mine and mine.id == one.id)) for one in sessions]


def enter_paired(
    access: Access, request: Request, response: Response, *, grant: PairingGrant
) -> Me:
    """Begin the session of a paired phone, and set its cookie."""
    caller = _caller(request)
    token = access.sessions.begin(
        grant.person, address=caller.address, agent=caller.agent, phone_role=grant.role
    )
    access.log.add(grant.person, caller.address, action="pair phone", what=grant.role)
    _set_cookie(request, response, token, lasts_s=PHONE_LIFE.whole_s)
    return _me(access, grant.person, role=grant.role, token=token)


def enter_guest(access: Access, request: Request, response: Response, *, entry: GuestEntry) -> None:
    """Set the cookie of a guest; the guest's session that this browser had before ends."""
    before: Session | None = request.scope["state"].get("session")
    if before is not None and access.sessions.alive(before.id):
        access.sessions.end(before.id)
    lasts_s = min(LIVES[Role.GUEST].whole_s, entry.link.until_s - time.time())
    _set_cookie(request, response, entry.token, lasts_s=max(1.0, lasts_s))


def _with_login(access: Access) -> Access:
    if not access.login:
        raise Conflict(CodedText("no-login", name=LOCAL.name))
    return access


def _caller(request: Request) -> LoginOrigin:
    return LoginOrigin(
        address=address(request),
        agent=request.headers.get("user-agent", ""),
        browser=cookie(request.scope, _cookies(request).browser)[:100],
    )


def _start_session(
    access: Access, request: Request, response: Response, *, result: LoginResult
) -> Me:
    """Set the cookies; the session this browser had before ends."""
    name, role = result.account.name, result.account.role
    before: Session | None = request.scope["state"].get("session")
    if before is not None and access.sessions.alive(before.id):
        access.sessions.end(before.id)
    access.log.add(name, address(request), action="sign in", what=role)
    _set_cookie(request, response, result.session, lasts_s=LIVES[role].whole_s)
    names = _cookies(request)
    response.set_cookie(
        names.browser,
        result.browser,
        max_age=int(SESSION_TIMES.browser_known_s),
        path=names.path,
        secure=True,
        httponly=True,
        samesite="strict",
    )
    return _me(access, name, role=role, token=result.session)


def _cookies(request: Request) -> CookieNames:
    return cookie_names(prefix_of(request.scope))


def _set_cookie(request: Request, response: Response, token: str, *, lasts_s: float) -> None:
    names = _cookies(request)
    response.set_cookie(
        names.session,
        token,
        max_age=int(lasts_s),
        path=names.path,
        secure=True,
        httponly=True,
        samesite="strict",
    )


def _me(access: Access, name: str, *, role: Role, token: str) -> Me:
    may = tuple(what for what in Permission if what in MAY[role])
    given = form_token(token) if access.login else ""
    return Me(name=name, role=role, may=may, login=access.login, token=given)


def _note_failure(access: Access, request: Request, name: str, *, error: AppError) -> None:
    """Log a failed login without an unknown name: people type their password there by mistake."""
    known = access.accounts.active_password_hash(name) is not None
    outcome = "refused" if isinstance(error, TooMany) else "failed"
    who = access.accounts.get(name).name if known else "nobody"
    what = str(error) if known else f"an unknown name: {error}"
    access.log.add(who, address(request), action="sign in", what=what, outcome=outcome)
