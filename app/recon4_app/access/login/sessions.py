"""Sessions: an opaque random token in a cookie, everything else in the database.

Only the hash of a token is stored: a person who reads the database cannot sign in with it.
"""

from __future__ import annotations

import hashlib
import hmac
import math
import secrets
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from recon4.locales.coded import CodedText
from recon4.units import HOUR_S
from recon4_app.access.audit import printable
from recon4_app.access.database import (
    GUEST_LINKS,
    KNOWN_BROWSERS,
    PEOPLE,
    SESSIONS,
    writing,
)
from recon4_app.access.login.accounts import lookup_key
from recon4_app.access.people import MAY, Permission, Person, Role
from recon4_app.access.tuning import ACCESS_TOKEN, SESSION_TIMES
from recon4_app.errors import Conflict, NoRoom, NotFound

GUEST_NAME = "guest: "
"""Begins the name of a guest; no account has a colon in its name."""
MAY_INVITE = PEOPLE.c.role.in_([role for role in Role if Permission.SHARE in MAY[role]])
LINK_OPENS = GUEST_LINKS.c.revoked_s.is_(None) & MAY_INVITE
"""A link that was not revoked, of somebody who may still make one."""


@dataclass(frozen=True, slots=True)
class Life:
    """Limits of a session's duration."""

    whole_s: float
    """From the login [s]."""
    idle_s: float
    """Since the last request [s]."""


LIVES = {
    Role.GUEST: Life(12 * HOUR_S, 2 * HOUR_S),
    Role.VIEWER: Life(12 * HOUR_S, 12 * HOUR_S),
    Role.OPERATOR: Life(12 * HOUR_S, 2 * HOUR_S),
    Role.REVIEWER: Life(12 * HOUR_S, 2 * HOUR_S),
    Role.ADMIN: Life(8 * HOUR_S, 0.5 * HOUR_S),
}
PHONE_LIFE = Life(12 * HOUR_S, 12 * HOUR_S)
"""A phone stays in a pocket for hours of a walk."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Session:
    """A login of a person on a device."""

    id: str
    """Public identifier of the session; not the secret."""
    person: str
    role: Role
    began_s: float
    """Login, seconds since 1970."""
    proved_s: float
    """When the password was last given, seconds since 1970."""
    seen_s: float
    """Last request, seconds since 1970."""
    address: str
    agent: str
    """User-Agent header of the browser."""
    phone: bool = False
    """Whether it is a paired phone; ``person`` paired it, ``role`` is the phone's own."""
    guest_link: str = ""
    """Id of the guest link that began it; empty = a login or a phone."""
    project: str = ""
    """The only project that a guest may see; empty = all."""
    access_token: str = ""
    """Name of the token of a program; ``person`` made it, ``role`` is its own. Empty = none."""
    until_s: float = math.inf
    """When the guest link or the token expires, seconds since 1970."""

    def over(self, now_s: float) -> bool:
        """Whether the session has expired."""
        if self.access_token:
            return now_s >= self.until_s
        life = PHONE_LIFE if self.phone else LIVES[self.role]
        old = now_s - self.began_s > life.whole_s or now_s - self.seen_s > life.idle_s
        return old or now_s >= self.until_s


@dataclass(frozen=True, slots=True)
class AuthenticatedSession:
    """The session of a request, with the hash of its token."""

    session: Session
    token_hash: str

    @property
    def person(self) -> Person:
        """The person of the session."""
        return Person(self.session.person, self.session.role, self.session.project)


class Sessions:
    """All sessions of a server; thread-safe."""

    def __init__(self, engine: sa.Engine, clock: Callable[[], float] = time.time) -> None:
        self._engine = engine
        self._clock = clock
        self._cached: dict[str, tuple[float, AuthenticatedSession]] = {}
        self._lock = threading.Lock()

    def begin(self, name: str, *, address: str, agent: str, phone_role: Role | None = None) -> str:
        """Begin a session of a person, or of a phone a person paired.

        Returns:
            Its token, which is stored nowhere.
        """
        token, now_s = new_token(), self._clock()
        row = session_row(token, now_s, address=address, agent=agent)
        row |= {"person": lookup_key(name), "phone_role": phone_role}
        with writing(self._engine) as connection:
            connection.execute(SESSIONS.delete().where(_outdated(now_s)))
            connection.execute(SESSIONS.insert().values(**row))
        return token

    def issue(self, name: str, role: Role, *, label: str, days: int, address: str) -> str:
        """Make a token for a program of a person, with a role of its own.

        Returns:
            The token, which is stored nowhere.

        Raises:
            Conflict: If the person has too many.
        """
        token, now_s = new_token(), self._clock()
        row = session_row(token, now_s, address=address, agent="")
        row |= {"person": lookup_key(name), "phone_role": role, "access_token": label}
        row |= {"until_s": now_s + days * 24 * HOUR_S}
        mine = (SESSIONS.c.person == lookup_key(name)) & SESSIONS.c.access_token.is_not(None)
        with writing(self._engine) as connection:
            connection.execute(SESSIONS.delete().where(_outdated(now_s)))
            count = sa.select(sa.func.count()).select_from(SESSIONS).where(mine)
            if connection.execute(count).scalar_one() >= ACCESS_TOKEN.max_of_a_person:
                raise Conflict(CodedText("tokens-too-many", limit=ACCESS_TOKEN.max_of_a_person))
            connection.execute(SESSIONS.insert().values(**row))
        return token

    def cached_sessions(self, token: str) -> AuthenticatedSession | None:
        """The session of a token from the cache, without a database query; None if not cached."""
        until_s, found_session = self._cached.get(hash_of(token), (0.0, None))
        fresh = (
            found_session
            and time.monotonic() < until_s
            and not found_session.session.over(self._clock())
        )
        return found_session if fresh else None

    def find(self, token: str) -> AuthenticatedSession | None:
        """The session of a token; None if missing, expired or of a disabled person."""
        token_hash = hash_of(token)
        with self._lock:  # an end that comes between reading and caching waits
            found = self._select(SESSIONS.c.token_hash == token_hash)
            if not found or found[0].over(self._clock()):
                self._cached.pop(token_hash, None)
                return None
            if len(self._cached) > 1000:
                self._cached.clear()
            found_session = AuthenticatedSession(found[0], token_hash)
            self._cached[token_hash] = (time.monotonic() + SESSION_TIMES.cached_s, found_session)
            return found_session

    def alive(self, session_id: str) -> Session | None:
        """A session that has not expired, by its identifier."""
        found = self._select(SESSIONS.c.id == session_id)
        return found[0] if found and not found[0].over(self._clock()) else None

    def unnoted(self, session: Session) -> bool:
        """Whether the last use of a session is due to be written."""
        return self._clock() - session.seen_s > SESSION_TIMES.noted_every_s

    def note(self, session: Session) -> None:
        """Write that a session is in use now; on a full disk it is left out."""
        now_s = self._clock()
        with suppress(NoRoom):
            self._write(SESSIONS.update().where(SESSIONS.c.id == session.id).values(seen_s=now_s))

    def prove(self, session_id: str) -> str:
        """A new token for the same session, after the password was given again."""
        token = new_token()
        values = {"token_hash": hash_of(token), "proved_s": self._clock()}
        self._write(SESSIONS.update().where(SESSIONS.c.id == session_id).values(**values))
        return token

    def age_s(self, session: Session) -> float:
        """Seconds since the password was last given."""
        age_s = self._clock() - session.proved_s
        return max(0.0, age_s) if age_s > -SESSION_TIMES.clock_step_s else math.inf

    def all(self, *, person: str | None = None) -> list[Session]:
        """Sessions that have not expired, the latest first; of one person, or of all.

        Those of guests are listed with their links (`recon4_app.access.guests`).
        """
        mine: sa.ColumnElement[bool] = SESSIONS.c.guest_link.is_(None)
        if person is not None:
            mine &= SESSIONS.c.person == lookup_key(person)
        now_s = self._clock()
        return [session for session in self._select(mine) if not session.over(now_s)]

    def end(self, session_id: str, *, person: str | None = None) -> None:
        """End a session; with ``person`` only one of that person.

        Raises:
            NotFound: If there is no such session.
        """
        mine = SESSIONS.c.id == session_id
        if person is not None:
            mine &= SESSIONS.c.person == lookup_key(person)
        if self._write(SESSIONS.delete().where(mine)) == 0:
            raise NotFound(CodedText("session-unknown", session=session_id[:32]))

    def forget_cached(self) -> None:
        """Empty the cache, because sessions may have ended."""
        with self._lock:
            self._cached.clear()

    # -- known browsers

    def know_browser(self, name: str) -> str:
        """A new token for a browser with which the person signed in."""
        token, now_s = new_token(), self._clock()
        row = {"token_hash": hash_of(token), "person": lookup_key(name), "known_s": now_s}
        with writing(self._engine) as connection:
            old = KNOWN_BROWSERS.delete().where(
                KNOWN_BROWSERS.c.known_s < now_s - SESSION_TIMES.browser_known_s
            )
            connection.execute(old)
            connection.execute(KNOWN_BROWSERS.insert().values(**row))
        return token

    def knows_browser(self, token: str, name: str) -> bool:
        """Whether the person has signed in with this browser before."""
        columns = KNOWN_BROWSERS.c
        mine = (columns.token_hash == hash_of(token)) & (columns.person == lookup_key(name))
        with self._engine.connect() as connection:
            known_s = connection.execute(sa.select(columns.known_s).where(mine)).scalar()
        return known_s is not None and self._clock() - known_s < SESSION_TIMES.browser_known_s

    def _select(self, condition: sa.ColumnElement[bool]) -> list[Session]:
        own = ("id", "began_s", "proved_s", "seen_s", "address", "agent")
        link, token = GUEST_LINKS.c, SESSIONS.c.access_token
        guest = SESSIONS.c.guest_link.is_not(None)
        join = sa.join(SESSIONS, PEOPLE, SESSIONS.c.person == PEOPLE.c.key)
        join = sa.outerjoin(join, GUEST_LINKS, SESSIONS.c.guest_link == link.id)
        query = sa.select(
            *(SESSIONS.c[name] for name in own),
            sa.case((guest, GUEST_NAME + link.label), else_=PEOPLE.c.name).label("person"),
            sa.case(
                (guest, Role.GUEST.value),
                else_=sa.func.coalesce(SESSIONS.c.phone_role, PEOPLE.c.role),
            ).label("role"),
            (SESSIONS.c.phone_role.is_not(None) & token.is_(None)).label("phone"),
            sa.func.coalesce(token, "").label("access_token"),
            sa.func.coalesce(link.id, "").label("guest_link"),
            sa.func.coalesce(link.project, "").label("project"),
            sa.func.coalesce(link.until_s, SESSIONS.c.until_s, math.inf).label("until_s"),
        )
        query = query.select_from(join).where(condition, ~PEOPLE.c.disabled, ~guest | LINK_OPENS)
        with self._engine.connect() as connection:
            rows = connection.execute(query.order_by(SESSIONS.c.began_s.desc()))
            return [Session(**row._asdict() | {"role": Role(row.role)}) for row in rows]

    def _write(self, statement: sa.Update | sa.Delete) -> int:
        with self._lock, writing(self._engine) as connection:
            changed: Any = connection.execute(statement)
            self._cached.clear()
            return int(changed.rowcount)


def _outdated(now_s: float) -> sa.ColumnElement[bool]:
    """Sessions that have expired, whatever their role."""
    longest_s = max(life.whole_s for life in LIVES.values())
    columns = SESSIONS.c
    old_login = columns.access_token.is_(None) & (columns.began_s < now_s - longest_s)
    return sa.or_(old_login, columns.until_s <= now_s)


def session_row(token: str, now_s: float, *, address: str, agent: str) -> dict[str, object]:
    """Columns of a session that begins now."""
    return {
        "id": secrets.token_hex(8),
        "token_hash": hash_of(token),
        "address": address,
        "agent": printable(agent[:120]),
        **dict.fromkeys(("began_s", "proved_s", "seen_s"), now_s),
    }


def new_token() -> str:
    """256 random bits."""
    return secrets.token_urlsafe(32)


def hash_of(token: str) -> str:
    """The stored hash of a token; a token is random, so one round of SHA-256 is enough."""
    return hashlib.sha256(token.encode("utf-8", "replace")).hexdigest()


def form_token(session_token: str) -> str:
    """The CSRF token a page sends with every change; bound to the session."""
    return hmac.new(session_token.encode(), b"recon4 form token", hashlib.sha256).hexdigest()
