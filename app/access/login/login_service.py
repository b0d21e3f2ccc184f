"""Signing in: name and password, or the one-time link of a server that has no admin yet."""

from __future__ import annotations

import hmac
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import sqlalchemy as sa

from app.access.audit import AuditLog
from app.access.database import open_database
from app.access.login import passwords
from app.access.login.accounts import Account, Accounts, key
from app.access.login.login_backoff import LoginBackoff, TokenBuckets, network
from app.access.login.sessions import Sessions, hash_of, new_token
from app.access.pairing.grants import Pairings
from app.access.people import Role
from app.errors import Refused, TooMany, WrongPassword

WRONG = "name and password do not fit"
"""Said of a wrong name, a wrong password and a disabled person alike."""
CONCURRENT_LOGINS = 2
"""Passwords verified at the same time; each takes 64 MiB."""


@dataclass(frozen=True, slots=True)
class LoginOrigin:
    """Where a login comes from."""

    address: str
    agent: str
    browser: str
    """Token of a browser that signed in before; empty = none."""


@dataclass(frozen=True, slots=True)
class LoginResult:
    """What a browser gets for the right password."""

    account: Account
    session: str
    """Token of the session."""
    browser: str
    """Token that makes this browser known."""


class LoginService:
    """Lets people in."""

    def __init__(
        self,
        accounts: Accounts,
        sessions: Sessions,
        *,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._accounts, self._sessions = accounts, sessions
        self._waits = LoginBackoff(clock=clock)
        self._addresses = TokenBuckets(burst=100, per_s=100 / 3600, clock=clock)
        self._verifying = threading.Semaphore(CONCURRENT_LOGINS)
        self._setup_hash = ""
        self._setup_lock = threading.Lock()

    def enter(self, name: str, password: str, caller: LoginOrigin) -> LoginResult:
        """Sign in.

        Raises:
            WrongPassword: If name and password do not fit.
            TooMany: If there were too many failures from there.
        """
        self.prove(name, password, caller)
        return self._let_in(self._accounts.get(name), caller)

    def prove(self, name: str, password: str, caller: LoginOrigin) -> None:
        """See that a password is a person's; tries are throttled for each person and address.

        A browser that signed in before is counted by itself: guesses of others behind the same
        address do not delay the owner.

        Raises:
            WrongPassword: If name and password do not fit.
            TooMany: If there were too many failures from there.
        """
        place = network(caller.address)
        known = bool(caller.browser) and self._sessions.knows_browser(caller.browser, name)
        source = hash_of(caller.browser) if known else place
        wait_s = self._waits.begin((key(name)[:64], source))
        if not wait_s and not known:
            wait_s = self._addresses.take(place)
        if wait_s:
            raise TooMany("too many wrong tries; wait a while", retry_after_s=wait_s)
        if not self._fits(name, password):
            raise WrongPassword(WRONG)
        self._waits.succeed((key(name)[:64], source))
        if not known:
            self._addresses.give_back(place)

    def open_setup(self) -> str:
        """A new one-time token to make the first admin; the one before is void."""
        token = new_token()
        self._setup_hash = hash_of(token)
        return token

    def set_up(self, token: str, name: str, *, password: str, caller: LoginOrigin) -> LoginResult:
        """Make the first admin with the one-time token, and sign in.

        Raises:
            Refused: If the token is not the one shown, was used, or there is an admin.
            WeakPassword: If the password is guessed first; the token stays good.
        """
        if wait_s := self._addresses.take(network(caller.address)):
            raise TooMany("too many tries; wait a while", retry_after_s=wait_s)
        with self._setup_lock:
            right = hmac.compare_digest(hash_of(token), self._setup_hash or hash_of(new_token()))
            if not right or self._accounts.has_admin():
                raise Refused("this link was used, or is of another start of the server")
            account = self._accounts.add(name, Role.ADMIN, password)
            self._setup_hash = ""
        return self._let_in(account, caller)

    def _fits(self, name: str, password: str) -> bool:
        stored = self._accounts.password_hash(name)
        with self._verifying:
            return passwords.fits(password[: passwords.LONGEST], stored)

    def _let_in(self, account: Account, caller: LoginOrigin) -> LoginResult:
        session = self._sessions.begin(account.name, address=caller.address, agent=caller.agent)
        return LoginResult(account, session, self._sessions.know_browser(account.name))


@dataclass(frozen=True, slots=True, kw_only=True)
class Access:
    """All of it, one a server."""

    login: bool
    """Whether people have to sign in; else whoever sits at this computer is an admin."""
    accounts: Accounts
    sessions: Sessions
    log: AuditLog
    logins: LoginService
    engine: sa.Engine
    pairings: Pairings
    rates: dict[str, TokenBuckets] = field(default_factory=dict)
    """How much of what each person started lately."""

    def close(self) -> None:
        """Let go of the file."""
        self.engine.dispose()


def open_access(state: Path, *, login: bool, clock: Callable[[], float] = time.time) -> Access:
    """Open the access database in the server's state folder.

    Args:
        state: The folder; exists.
        login: Whether people have to sign in.
        clock: Seconds since 1970; sessions and log go by it.
    """
    engine = open_database(state / "access.sqlite")
    accounts, sessions = Accounts(engine), Sessions(engine, clock)
    return Access(
        login=login,
        accounts=accounts,
        sessions=sessions,
        log=AuditLog(engine, clock),
        logins=LoginService(accounts, sessions),
        engine=engine,
        pairings=Pairings(),
    )
