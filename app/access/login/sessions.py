"""Sessions: an opaque random token in a cookie, everything else here.

Only the hash of a token is stored: who reads the database cannot sign in with what is in it.
"""

from __future__ import annotations

import hashlib
import hmac
import secrets
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import sqlalchemy as sa

from app.access.audit import printable
from app.access.database import BROWSERS, PEOPLE, SESSIONS, writing
from app.access.login.accounts import key
from app.access.people import Person, Role
from app.errors import NotFound

HOUR_S = 3600.0


@dataclass(frozen=True, slots=True)
class Life:
    """How long a session lasts."""

    whole_s: float
    """From the login [s]."""
    idle_s: float
    """Since the last request [s]."""


LIVES = {
    Role.VIEWER: Life(12 * HOUR_S, 12 * HOUR_S),
    Role.OPERATOR: Life(12 * HOUR_S, 2 * HOUR_S),
    Role.REVIEWER: Life(12 * HOUR_S, 2 * HOUR_S),
    Role.ADMIN: Life(8 * HOUR_S, 0.5 * HOUR_S),
}
PHONE_LIFE = Life(12 * HOUR_S, 12 * HOUR_S)
"""A phone lies in a pocket for hours of a walk."""
CACHED_S = 2.0
"""What was looked up is believed so long: a session ended by another process ends then [s]."""
NOTED_EVERY_S = 30.0
"""A session in use is noted as such this often [s]."""
BROWSER_KNOWN_S = 365 * 24 * HOUR_S


@dataclass(frozen=True, slots=True, kw_only=True)
class Session:
    """A login of a person on a device."""

    id: str
    """Public name of the session; not the secret."""
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
    """What the browser calls itself."""
    phone: bool = False
    """Whether it is a phone somebody let in; ``person`` is who did, ``role`` the phone's own."""

    def over(self, now_s: float) -> bool:
        """Whether its time is up."""
        life = PHONE_LIFE if self.phone else LIVES[self.role]
        return now_s - self.began_s > life.whole_s or now_s - self.seen_s > life.idle_s


@dataclass(frozen=True, slots=True)
class AuthenticatedSession:
    """A request's session."""

    session: Session
    token_hash: str

    @property
    def person(self) -> Person:
        """Who asks."""
        return Person(self.session.person, self.session.role)


class Sessions:
    """All sessions there are; safe to call from any thread."""

    def __init__(self, engine: sa.Engine, clock: Callable[[], float] = time.time) -> None:
        self._engine = engine
        self._clock = clock
        self._believed: dict[str, tuple[float, AuthenticatedSession]] = {}
        self._lock = threading.Lock()

    def begin(self, name: str, *, address: str, agent: str, phone_role: Role | None = None) -> str:
        """A new session of a person, or of a phone a person let in.

        Returns:
            Its token, which is kept nowhere.
        """
        token, now_s = new_token(), self._clock()
        row = {
            "id": secrets.token_hex(8),
            "token_hash": hash_of(token),
            "person": key(name),
            "address": address,
            "agent": printable(agent[:120]),
            "phone_role": phone_role,
            **dict.fromkeys(("began_s", "proved_s", "seen_s"), now_s),
        }
        longest_s = max(life.whole_s for life in LIVES.values())
        with writing(self._engine) as connection:
            old = SESSIONS.delete().where(SESSIONS.c.began_s < now_s - longest_s)
            connection.execute(old)
            connection.execute(SESSIONS.insert().values(**row))
        return token

    def cached_sessions(self, token: str) -> AuthenticatedSession | None:
        """What was looked up a moment ago, without asking the database."""
        until_s, visit = self._believed.get(hash_of(token), (0.0, None))
        fresh = visit and time.monotonic() < until_s and not visit.session.over(self._clock())
        return visit if fresh else None

    def find(self, token: str) -> AuthenticatedSession | None:
        """The session a token belongs to, None if there is none, or it or the person is over."""
        token_hash = hash_of(token)
        with self._lock:  # an end that comes between reading and believing waits
            found = self._select(SESSIONS.c.token_hash == token_hash)
            if not found or found[0].over(self._clock()):
                self._believed.pop(token_hash, None)
                return None
            if len(self._believed) > 1000:
                self._believed.clear()
            visit = AuthenticatedSession(found[0], token_hash)
            self._believed[token_hash] = (time.monotonic() + CACHED_S, visit)
            return visit

    def alive(self, session_id: str) -> Session | None:
        """A session that is not over, by its public name."""
        found = self._select(SESSIONS.c.id == session_id)
        return found[0] if found and not found[0].over(self._clock()) else None

    def unnoted(self, session: Session) -> bool:
        """Whether it is some time since it was noted that it is in use."""
        return self._clock() - session.seen_s > NOTED_EVERY_S

    def note(self, session: Session) -> None:
        """Note that it is in use."""
        now_s = self._clock()
        self._write(SESSIONS.update().where(SESSIONS.c.id == session.id).values(seen_s=now_s))

    def prove(self, session_id: str) -> str:
        """The password was given again: a new token for the same session."""
        token = new_token()
        values = {"token_hash": hash_of(token), "proved_s": self._clock()}
        self._write(SESSIONS.update().where(SESSIONS.c.id == session_id).values(**values))
        return token

    def age_s(self, session: Session) -> float:
        """Seconds since the password was last given."""
        return max(0.0, self._clock() - session.proved_s)

    def all(self, *, person: str | None = None) -> list[Session]:
        """Sessions that are not over, the latest first; of one person, or of everybody."""
        mine = SESSIONS.c.person == key(person) if person is not None else sa.true()
        now_s = self._clock()
        return [session for session in self._select(mine) if not session.over(now_s)]

    def end(self, session_id: str, *, person: str | None = None) -> None:
        """End a session, with ``person`` only if it is theirs.

        Raises:
            NotFound: If there is no such session.
        """
        mine = SESSIONS.c.id == session_id
        if person is not None:
            mine &= SESSIONS.c.person == key(person)
        if self._write(SESSIONS.delete().where(mine)) == 0:
            raise NotFound(f"no session {session_id[:32]!r}")

    def forget_cached(self) -> None:
        """Ask the database again: somebody's sessions may have ended."""
        with self._lock:
            self._believed.clear()

    # -- browsers a person has signed in with

    def know_browser(self, name: str) -> str:
        """A new token for a browser the person signed in with."""
        token, now_s = new_token(), self._clock()
        row = {"token_hash": hash_of(token), "person": key(name), "known_s": now_s}
        with writing(self._engine) as connection:
            old = BROWSERS.delete().where(BROWSERS.c.known_s < now_s - BROWSER_KNOWN_S)
            connection.execute(old)
            connection.execute(BROWSERS.insert().values(**row))
        return token

    def knows_browser(self, token: str, name: str) -> bool:
        """Whether the person signed in with this browser before."""
        mine = (BROWSERS.c.token_hash == hash_of(token)) & (BROWSERS.c.person == key(name))
        with self._engine.connect() as connection:
            known_s = connection.execute(sa.select(BROWSERS.c.known_s).where(mine)).scalar()
        return known_s is not None and self._clock() - known_s < BROWSER_KNOWN_S

    def _select(self, condition: sa.ColumnElement[bool]) -> list[Session]:
        join = sa.join(SESSIONS, PEOPLE, SESSIONS.c.person == PEOPLE.c.key)
        left_out = ("token_hash", "person", "phone_role")
        own = [column for column in SESSIONS.c if column.name not in left_out]
        role = sa.func.coalesce(SESSIONS.c.phone_role, PEOPLE.c.role).label("role")
        phone = SESSIONS.c.phone_role.is_not(None).label("phone")
        query = sa.select(*own, PEOPLE.c.name.label("person"), role, phone)
        query = query.select_from(join).where(condition, ~PEOPLE.c.disabled)
        with self._engine.connect() as connection:
            rows = connection.execute(query.order_by(SESSIONS.c.began_s.desc())).mappings()
            return [Session(**{**row, "role": Role(row["role"])}) for row in rows]

    def _write(self, statement: sa.Update | sa.Delete) -> int:
        with self._lock, writing(self._engine) as connection:
            changed: Any = connection.execute(statement)
            self._believed.clear()
            return int(changed.rowcount)


def new_token() -> str:
    """256 random bits."""
    return secrets.token_urlsafe(32)


def hash_of(token: str) -> str:
    """What is stored of a token; it is random, so one round is enough."""
    return hashlib.sha256(token.encode("utf-8", "replace")).hexdigest()


def form_token(session_token: str) -> str:
    """The token a page sends along with whatever changes something; bound to the session."""
    return hmac.new(session_token.encode(), b"recon4 form token", hashlib.sha256).hexdigest()
