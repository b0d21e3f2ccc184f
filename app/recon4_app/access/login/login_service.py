"""Login: name and password, or the one-time link of a server that has no admin yet."""

from __future__ import annotations

import hmac
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import sqlalchemy as sa

from recon4.locales.coded import CodedText
from recon4_app.access.audit import AuditLog
from recon4_app.access.database import open_database
from recon4_app.access.guests.guest_links import GuestLinks
from recon4_app.access.login import passwords
from recon4_app.access.login.accounts import Account, Accounts, lookup_key
from recon4_app.access.login.login_backoff import LoginBackoff, TokenBuckets, network
from recon4_app.access.login.sessions import Sessions, hash_of, new_token
from recon4_app.access.pairing.pairings import Pairings
from recon4_app.access.people import Role
from recon4_app.access.restoring import ACCESS_FILE
from recon4_app.access.tuning import LOGINS, PASSWORDS
from recon4_app.errors import NoRoom, Refused, TooMany, WrongPassword

"""The same message for a wrong name, a wrong password and a disabled account."""


@dataclass(frozen=True, slots=True)
class LoginOrigin:
    """The client a login comes from."""

    address: str
    agent: str
    browser: str
    """Token of a browser with an earlier login; empty = none."""


@dataclass(frozen=True, slots=True)
class LoginResult:
    """Tokens a browser receives after a login."""

    account: Account
    session: str
    """Token of the session."""
    browser: str
    """Token that makes this browser known."""


class LoginService:
    """Verifies passwords and begins sessions."""

    def __init__(
        self,
        accounts: Accounts,
        sessions: Sessions,
        *,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._accounts, self._sessions = accounts, sessions
        self._backoff = LoginBackoff(clock=clock)
        self._addresses = TokenBuckets(burst=100, per_s=100 / 3600, clock=clock)
        self._verifying = threading.Semaphore(LOGINS.concurrent_logins)
        self._waiting = threading.BoundedSemaphore(LOGINS.waiting_logins)
        self._setup_hash = ""
        self._setup_lock = threading.Lock()

    def sign_in(self, name: str, password: str, caller: LoginOrigin) -> LoginResult:
        """Verify the password and begin a session.

        Raises:
            WrongPassword: If wrong name or password.
            TooMany: If there were too many failures from that client.
        """
        self.prove(name, password, caller)
        return self._begin_session(self._accounts.get(name), caller)

    def prove(self, name: str, password: str, caller: LoginOrigin) -> None:
        """Verify a person's password; attempts are limited per person and address.

        A browser that signed in before is counted by itself: failed logins of others behind the
        same address do not delay the owner, nor does a flood of logins from many addresses.

        Raises:
            WrongPassword: If wrong name or password.
            TooMany: If there were too many failures from that client, or too many logins at once.
        """
        known = bool(caller.browser) and self._sessions.knows_browser(caller.browser, name)
        if known:
            self._prove(name, password, caller, known=True)
            return
        if not self._waiting.acquire(blocking=False):
            raise TooMany(CodedText("logins-at-once"), retry_after_s=2.0)
        try:
            self._prove(name, password, caller, known=False)
        finally:
            self._waiting.release()

    def _prove(self, name: str, password: str, caller: LoginOrigin, *, known: bool) -> None:
        place = network(caller.address)
        source = hash_of(caller.browser) if known else place
        wait_s = self._backoff.begin((lookup_key(name)[:64], source))
        if not wait_s and not known:
            wait_s = self._addresses.take(place)
        if wait_s:
            raise TooMany(CodedText("logins-failed"), retry_after_s=wait_s)
        if not self._fits(name, password):
            raise WrongPassword(CodedText("login-wrong"))
        self._backoff.succeed((lookup_key(name)[:64], source))
        if not known:
            self._addresses.give_back(place)

    def open_setup(self) -> str:
        """A new one-time token to create the first admin; the one before is void."""
        token = new_token()
        self._setup_hash = hash_of(token)
        return token

    def set_up(self, token: str, name: str, *, password: str, caller: LoginOrigin) -> LoginResult:
        """Create the first admin with the one-time token, and sign in.

        Raises:
            Refused: If the token is not the one shown, was used, or there is an admin.
            WeakPassword: If the password is too easy to find; the token stays valid.
        """
        if wait_s := self._addresses.take(network(caller.address)):
            raise TooMany(CodedText("setup-attempts"), retry_after_s=wait_s)
        with self._setup_lock:
            right = hmac.compare_digest(hash_of(token), self._setup_hash or hash_of(new_token()))
            if not right or self._accounts.has_admin():
                raise Refused(CodedText("setup-link-used"))
            account = self._accounts.add(name, Role.ADMIN, password)
            self._setup_hash = ""
        return self._begin_session(account, caller)

    def _fits(self, name: str, password: str) -> bool:
        stored = self._accounts.active_password_hash(name)
        with self._verifying:
            return passwords.matches(password[: PASSWORDS.longest], stored)

    def _begin_session(self, account: Account, caller: LoginOrigin) -> LoginResult:
        session = self._sessions.begin(account.name, address=caller.address, agent=caller.agent)
        return LoginResult(account, session, self._sessions.know_browser(account.name))


@dataclass(frozen=True, slots=True, kw_only=True)
class Access:
    """Accounts, sessions, audit log and pairing of a server."""

    login: bool
    """Whether people have to sign in; else the person at this computer is an admin."""
    accounts: Accounts
    sessions: Sessions
    log: AuditLog
    logins: LoginService
    engine: sa.Engine
    pairings: Pairings
    guests: GuestLinks
    notice: str = ""
    """Notice for users: set when the database was damaged, else empty."""
    rates: dict[str, TokenBuckets] = field(default_factory=dict)
    """Action -> rate limit per person."""

    def close(self) -> None:
        """Close the database."""
        self.engine.dispose()


def open_access(
    state: Path, *, login: bool, notice: str = "", clock: Callable[[], float] = time.time
) -> Access:
    """Open the access database in the server's state folder.

    Args:
        state: The folder; exists.
        login: Whether people have to sign in.
        notice: What was restored (`restore_access`); noted in the audit log.
        clock: Seconds since 1970, for sessions and the log.
    """
    engine = open_database(state / ACCESS_FILE)
    accounts, sessions = Accounts(engine), Sessions(engine, clock)
    log = AuditLog(engine, clock)
    with suppress(NoRoom):
        log.require_room()  # kept from the start: later the disk may be full
    if notice:
        log.add("server", "", action="restore people", what=notice)
    return Access(
        login=login,
        notice=notice,
        accounts=accounts,
        sessions=sessions,
        log=log,
        logins=LoginService(accounts, sessions),
        engine=engine,
        pairings=Pairings(),
        guests=GuestLinks(engine, sessions, clock),
    )
