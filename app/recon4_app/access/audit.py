"""The audit log: who did what, when, from where, to what, and with which outcome.

Every row carries the hash of itself and the row before, so a row changed or removed later is found.
An attacker who can write the file can compute the whole chain again. The newest hash, noted
elsewhere, reveals that.
"""

from __future__ import annotations

import hashlib
import json
import logging
import threading
import time
import unicodedata
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime

import sqlalchemy as sa
from starlette.requests import HTTPConnection

from recon4.locales.coded import CodedText
from recon4.store.hashing import CHAIN_START
from recon4_app.access.database import AUDIT, reserve_of, writing
from recon4_app.access.tuning import AUDIT_LOG
from recon4_app.errors import NoRoom

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A row of the audit log."""

    number: int
    time: str
    """UTC, ISO 8601."""
    person: str
    address: str
    """Network address of the client."""
    action: str
    object: str
    outcome: str
    """``done``, ``refused`` or ``failed``."""
    hash: str
    """SHA-256 of the fields above and of the row before, hexadecimal."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainCheck:
    """Result of verifying the hash chain."""

    last_number: int
    """Number of the newest row; 0 = the log is empty."""
    broken_at: int | None
    """Number of the first row whose hash does not match; None = the chain is whole."""
    head_hash: str
    """Hash of the newest row."""


class AuditLog:
    """Appends to the log and reads it."""

    def __init__(self, engine: sa.Engine, clock: Callable[[], float] = time.time) -> None:
        self._engine = engine
        self._clock = clock
        self._lock = threading.Lock()
        self._minute, self._failures, self._unwritten = 0, 0, 0

    def add(
        self, person: str, address: str, *, action: str, what: str, outcome: str = "done"
    ) -> None:
        """Append a row; it is on disk when this returns.

        A refusal or failure that cannot be written is counted like those of a flood: it stays a
        refusal.

        Raises:
            NoRoom: If something was done and the disk is too full to write that.
        """
        if outcome != "done" and not (what := self._counted(what)):
            return
        try:
            self._append(person, address, action=action, what=what, outcome=outcome)
        except NoRoom as error:
            log.error("not in the audit log, the disk is full: %s %s", action, outcome)
            if outcome == "done":
                raise NoRoom(CodedText("done-not-logged", action=action)) from error
            with self._lock:
                self._unwritten += 1

    def require_room(self) -> None:
        """Refuse what could not be entered; call it before something is done.

        Raises:
            NoRoom: If the disk is too full.
        """
        reserve_of(self._engine).require()

    def _append(self, person: str, address: str, *, action: str, what: str, outcome: str) -> None:
        timestamp = datetime.fromtimestamp(self._clock(), UTC).isoformat(timespec="milliseconds")
        texts = dict(person=person, address=address, action=action, object=what, outcome=outcome)
        texts = {name: printable(text) for name, text in texts.items()}
        newest = sa.select(AUDIT.c.number, AUDIT.c.hash).order_by(AUDIT.c.number.desc()).limit(1)
        with writing(self._engine) as connection:
            number, previous_hash = connection.execute(newest).one_or_none() or (0, CHAIN_START)
            entry = Entry(number=number + 1, time=timestamp, **texts, hash="")
            entry = replace(entry, hash=entry_hash(previous_hash, entry))
            connection.execute(AUDIT.insert().values(**asdict(entry)))

    def newest(self, limit: int, *, before_number: int | None = None) -> list[Entry]:
        """The newest rows, newest first; with ``before_number`` those older than that row."""
        query = AUDIT.select().order_by(AUDIT.c.number.desc()).limit(limit)
        if before_number is not None:
            query = query.where(AUDIT.c.number < before_number)
        with self._engine.connect() as connection:
            return [Entry(**row._asdict()) for row in connection.execute(query)]

    def verify(self) -> ChainCheck:
        """Verify the hash chain: compute every hash again."""
        with self._engine.connect() as connection:
            rows = connection.execute(AUDIT.select().order_by(AUDIT.c.number))
            return verify_chain(Entry(**row._asdict()) for row in rows)

    def _counted(self, what: str) -> str:
        """The object of a failure with the number left out before it; empty = leave it out."""
        with self._lock:
            minute = int(self._clock() // 60)
            if minute != self._minute:
                self._minute, self._failures = minute, 0
            self._failures += 1
            if self._failures > AUDIT_LOG.max_failures_per_minute:
                self._unwritten += 1
                return ""
            left_out, self._unwritten = self._unwritten, 0
        return f"{what} (after {left_out} more that were not written)" if left_out else what or "-"


def audit(connection: HTTPConnection, action: str, what: str, *, outcome: str = "done") -> None:
    """Append an entry about a request; it is on disk when this returns.

    Args:
        connection: The request or WebSocket.
        action: A verb, as ``start job``.
        what: Its object, as ``office``.
        outcome: ``done``, ``refused`` or ``failed``.
    """
    log: AuditLog = connection.app.state.parts.access.log
    state = connection.scope["state"]
    session = state.get("session")
    if session is not None and session.access_token:
        what = f"{what} (access token {session.access_token})"
    log.add(state["person"].name, address(connection), action=action, what=what, outcome=outcome)


def address(connection: HTTPConnection) -> str:
    """Network address a request came from."""
    return connection.client.host if connection.client else "?"


def entry_hash(previous_hash: str, entry: Entry) -> str:
    """The hash of a row, given that of the row before."""
    fields = {name: value for name, value in asdict(entry).items() if name != "hash"}
    text = json.dumps([previous_hash, fields], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def verify_chain(rows: Iterable[Entry]) -> ChainCheck:
    """Verify the hash chain from its beginning."""
    previous_hash, number, broken = CHAIN_START, 0, None
    for row in rows:
        whole = row.number == number + 1 and row.hash == entry_hash(previous_hash, row)
        if broken is None and not whole:
            broken = row.number
        previous_hash, number = row.hash, row.number
    return ChainCheck(last_number=number, broken_at=broken, head_hash=previous_hash)


def printable(text: str) -> str:
    """The text without control characters, which could forge lines, cut where it is long."""
    kept = text[: AUDIT_LOG.max_text_chars]
    shown = "".join("\N{REPLACEMENT CHARACTER}" if _hidden(one) else one for one in kept)
    return shown.encode("utf-8", "replace").decode()


def _hidden(character: str) -> bool:
    return unicodedata.category(character) in {"Cc", "Cf", "Cs", "Zl", "Zp"}
