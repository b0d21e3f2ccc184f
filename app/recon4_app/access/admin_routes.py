"""HTTP routes for admins: people, the sessions of all people, the audit log."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request
from pydantic import Field

from recon4_app.access.audit import Entry, audit
from recon4_app.access.login.accounts import Account
from recon4_app.access.login.routes import SessionView, Text, Wire, views
from recon4_app.access.people import Permission, Role, needs, recent_login
from recon4_app.deps import Server
from recon4_app.error_responses import problems

router = APIRouter(
    prefix="/api",
    tags=["administration"],
    dependencies=[Depends(needs(Permission.ADMINISTER))],
    responses=problems(403, 404, 409),
)
RECENT_LOGIN = Depends(recent_login)


class NewPerson(Wire):
    """An account to be added."""

    name: Text
    role: Role
    password: Text
    """Initial password; the person can change it."""


class Changes(Wire):
    """Changes of an account; a field that is left out stays."""

    role: Role | None = None
    disabled: bool | None = None
    password: Annotated[str | None, Field(max_length=1000)] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainView:
    """Result of verifying the hash chain."""

    entries: int
    """Number of the newest entry."""
    broken_at: int | None
    """Number of the first entry whose hash does not match; null = the chain is whole."""
    newest: str
    """Hash of the newest entry."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Log:
    """A page of the audit log."""

    entries: list[Entry]
    """The newest first."""
    chain: ChainView


@router.get("/people")
def list_people(server: Server) -> list[Account]:
    """List the accounts of all people."""
    return server.access.accounts.all()


@router.post("/people", status_code=201, dependencies=[RECENT_LOGIN])
def add_person(new: NewPerson, request: Request, server: Server) -> Account:
    """Add a person."""
    account = server.access.accounts.add(new.name, new.role, new.password)
    audit(request, "add person", f"{account.name}, {account.role}")
    return account


@router.patch("/people/{name}", dependencies=[RECENT_LOGIN])
def change_person(name: str, changes: Changes, request: Request, *, server: Server) -> Account:
    """Change the role or password, disable or enable the account; the person's sessions end."""
    accounts = server.access.accounts
    account = accounts.get(name)
    if changes.password is not None:
        account = accounts.set_password(name, changes.password)
        audit(request, "set password", account.name)
    if changes.role is not None:
        account = accounts.set_role(name, changes.role)
        audit(request, "set role", f"{account.name}, {account.role}")
    if changes.disabled is not None:
        account = accounts.set_disabled(name, changes.disabled)
        audit(request, "disable" if changes.disabled else "enable", account.name)
    server.access.sessions.forget_cached()
    return account


@router.get("/sessions")
def list_sessions(request: Request, server: Server) -> list[SessionView]:
    """List the sessions of all people."""
    return views(request, server.access.sessions.all())


@router.delete("/sessions/{session_id}", status_code=204)
def end_session(session_id: str, request: Request, server: Server) -> None:
    """End a session; its open streams and WebSockets close within seconds."""
    server.access.sessions.end(session_id)
    audit(request, "end session", session_id)


@router.get("/audit")
def read_audit(
    server: Server,
    most: Annotated[int, Query(ge=1, le=1000)] = 100,
    before: Annotated[int | None, Query(ge=1, le=1 << 62)] = None,
) -> Log:
    """Read the audit log, and verify its hash chain."""
    log = server.access.log
    entries, found = log.newest(most, before_number=before), log.verify()
    chain = ChainView(entries=found.last_number, broken_at=found.broken_at, newest=found.head_hash)
    return Log(entries=entries, chain=chain)
