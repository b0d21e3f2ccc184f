"""Guest links: a person who has one sees the map, the slices and the report of one project.

A link is a random token; the database has its hash only. It stands in the fragment of an address,
which browsers send nowhere, and is exchanged for a session at once. The session ends when the link
expires or is revoked, and when its maker is disabled or may share no longer.
"""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import sqlalchemy as sa

from recon4.locales.coded import CodedText
from recon4.units import HOUR_S
from recon4_app.access.database import GUEST_LINKS, PEOPLE, SESSIONS, writing
from recon4_app.access.login.accounts import lookup_key
from recon4_app.access.login.login_backoff import TokenBuckets, network
from recon4_app.access.login.sessions import (
    LINK_OPENS,
    Sessions,
    hash_of,
    new_token,
    session_row,
)
from recon4_app.access.people import Person
from recon4_app.access.tuning import GUEST_LINK
from recon4_app.errors import Conflict, NotFound, Refused, TooMany


@dataclass(frozen=True, slots=True, kw_only=True)
class GuestLink:
    """A link as the list shows it; its token is known to nobody but who has it."""

    id: str
    project: str
    label: str
    """For whom it is."""
    by: str
    """Who made it."""
    created_s: float
    """Seconds since 1970, as all times here."""
    until_s: float
    """When it expires."""
    opened: int
    """How often it was opened."""
    opened_s: float | None
    """When it was opened last."""
    revoked_s: float | None
    """None = it is not revoked."""
    revoked_by: str
    works: bool
    """Whether it opens the project now; its maker may share no longer, or it has ended."""


@dataclass(frozen=True, slots=True)
class GuestEntry:
    """A guest who just came in."""

    link: GuestLink
    token: str
    """Of the session."""


class GuestLinks:
    """All guest links of a server; thread-safe."""

    def __init__(
        self, engine: sa.Engine, sessions: Sessions, clock: Callable[[], float] = time.time
    ) -> None:
        self._engine, self._sessions, self._clock = engine, sessions, clock
        per_minute = GUEST_LINK.tries_a_minute
        self._tries = TokenBuckets(burst=per_minute, per_s=per_minute / 60)

    def make(self, project: str, maker: Person, *, label: str, days: int) -> tuple[GuestLink, str]:
        """A new link and its token, which is stored nowhere.

        Raises:
            Conflict: If the project has too many.
        """
        token, now_s = new_token(), self._clock()
        row = {
            "id": secrets.token_hex(6),
            "token_hash": hash_of(token),
            "project": project,
            "label": label,
            "person": lookup_key(maker.name),
            "created_s": now_s,
            "until_s": now_s + days * 24 * HOUR_S,
            "opened": 0,
            "revoked_by": "",
        }
        old = GUEST_LINKS.c.until_s < now_s - GUEST_LINK.kept_s
        with writing(self._engine) as connection:
            connection.execute(GUEST_LINKS.delete().where(old))
            live = GUEST_LINKS.c.revoked_s.is_(None) & (GUEST_LINKS.c.until_s > now_s)
            count = sa.select(sa.func.count()).where(live, GUEST_LINKS.c.project == project)
            if connection.execute(count).scalar_one() >= GUEST_LINK.max_open:
                raise Conflict(CodedText("guest-links-too-many", limit=GUEST_LINK.max_open))
            connection.execute(GUEST_LINKS.insert().values(**row))
        return self.one(project, str(row["id"])), token

    def of_project(self, project: str) -> list[GuestLink]:
        """Links to a project, the newest first; ended ones for a year."""
        return self._select(GUEST_LINKS.c.project == project)

    def one(self, project: str, link_id: str) -> GuestLink:
        """A link to a project.

        Raises:
            NotFound: If there is none.
        """
        same = (GUEST_LINKS.c.project == project) & (GUEST_LINKS.c.id == link_id)
        found = self._select(same)
        if not found:
            raise NotFound(CodedText("guest-link-unknown", link=link_id[:20], project=project))
        return found[0]

    def revoke(self, link: GuestLink, by: Person) -> None:
        """Revoke a link: the sessions of its guests end."""
        self._revoke(GUEST_LINKS.c.id == link.id, by)

    def revoke_all(self, project: str, by: Person) -> None:
        """Revoke all links to a project: another one may get its name."""
        self._revoke(GUEST_LINKS.c.project == project, by)

    def open(self, token: str, *, address: str, agent: str) -> GuestEntry:
        """Begin the session of a guest.

        Raises:
            Refused: If no such link opens a project now.
            TooMany: If there were too many attempts from that network.
        """
        if wait_s := self._tries.take(network(address)):
            raise TooMany(CodedText("attempts-too-many"), retry_after_s=wait_s)
        session, now_s = new_token(), self._clock()
        row = session_row(session, now_s, address=address, agent=agent)
        with writing(self._engine) as connection:  # a revocation comes before or after
            found = _links(connection, GUEST_LINKS.c.token_hash == hash_of(token), now_s)
            if not found or not found[0].works:
                raise Refused(_why_not(found[0] if found else None, now_s))
            (link,) = found
            mine = SESSIONS.c.guest_link == link.id
            newest = sa.select(SESSIONS.c.id).where(mine).order_by(SESSIONS.c.began_s.desc())
            stay = newest.limit(GUEST_LINK.max_sessions - 1)
            connection.execute(SESSIONS.delete().where(mine, SESSIONS.c.id.not_in(stay)))
            row |= {"person": lookup_key(link.by), "guest_link": link.id}
            connection.execute(SESSIONS.insert().values(**row))
            counted = GUEST_LINKS.update().where(GUEST_LINKS.c.id == link.id)
            values = {"opened": GUEST_LINKS.c.opened + 1, "opened_s": now_s}
            connection.execute(counted.values(**values))
        self._sessions.forget_cached()
        return GuestEntry(link, session)

    def _revoke(self, condition: sa.ColumnElement[bool], by: Person) -> None:
        these = condition & GUEST_LINKS.c.revoked_s.is_(None)
        with writing(self._engine) as connection:
            ids = sa.select(GUEST_LINKS.c.id).where(condition)
            connection.execute(SESSIONS.delete().where(SESSIONS.c.guest_link.in_(ids)))
            values = {"revoked_s": self._clock(), "revoked_by": by.name}
            connection.execute(GUEST_LINKS.update().where(these).values(**values))
        self._sessions.forget_cached()

    def _select(self, condition: sa.ColumnElement[bool]) -> list[GuestLink]:
        with self._engine.connect() as connection:
            return _links(connection, condition, self._clock())


def _why_not(link: GuestLink | None, now_s: float) -> CodedText:
    """Why a token opens nothing: only who was given it finds its link, a stranger finds none."""
    if link is not None and link.revoked_s is not None:
        return CodedText("guest-link-revoked", day=_day(link.revoked_s))
    if link is not None and link.until_s <= now_s:
        return CodedText("guest-link-expired", day=_day(link.until_s))
    return CodedText("guest-link-invalid")


def _day(t_s: float) -> str:
    return datetime.fromtimestamp(t_s, UTC).date().isoformat()


def _links(
    connection: sa.Connection, condition: sa.ColumnElement[bool], now_s: float
) -> list[GuestLink]:
    left_out = ("token_hash", "person")
    own = [column for column in GUEST_LINKS.c if column.name not in left_out]
    join = sa.join(GUEST_LINKS, PEOPLE, GUEST_LINKS.c.person == PEOPLE.c.key)
    works = LINK_OPENS & ~PEOPLE.c.disabled & (GUEST_LINKS.c.until_s > now_s)
    query = sa.select(*own, PEOPLE.c.name.label("by"), works.label("works"))
    query = query.select_from(join).where(condition).order_by(GUEST_LINKS.c.created_s.desc())
    rows: Any = connection.execute(query).mappings()
    return [GuestLink(**row) for row in rows]
