"""The append-only journal of a project: every decision with reviewer, time and reason.

``decisions.sqlite`` (WAL, synchronous FULL). Each row contains the hash of the one before it, so
`broken` finds a row that was changed, removed or inserted.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, text_of
from recon4.review.decisions import (
    ABOUT_CLASSES,
    ABOUT_WORK,
    VERDICTS,
    Decided,
    Decision,
    DecisionKind,
    Pair,
    correction_id,
    fold,
)
from recon4.store.atomic import raise_if_full
from recon4.store.hashing import CHAIN_START, hash_json
from recon4.store.seal import changing
from recon4.store.sqlite_files import (
    connect,
    connect_to_read,
    create_whole,
    has_room_beside,
    make_durable,
    merge_log,
    sync_commits,
)

NAME = "decisions.sqlite"

_SCHEMA = """
CREATE TABLE IF NOT EXISTS journal (
    seq INTEGER PRIMARY KEY,
    time TEXT NOT NULL,
    who TEXT NOT NULL,
    kind TEXT NOT NULL,
    frame_i INTEGER,
    frame_j INTEGER,
    body TEXT NOT NULL,
    why TEXT NOT NULL,
    prev_hash TEXT NOT NULL,
    hash TEXT NOT NULL
);
CREATE TRIGGER IF NOT EXISTS no_change BEFORE UPDATE ON journal
    BEGIN SELECT RAISE(ABORT, 'the journal is only appended to'); END;
CREATE TRIGGER IF NOT EXISTS no_removal BEFORE DELETE ON journal
    BEGIN SELECT RAISE(ABORT, 'the journal is only appended to'); END;
"""
_CHANGE_CLASSES = (*ABOUT_CLASSES, DecisionKind.UNDO, DecisionKind.REDO)
_COLUMNS = "seq, time, who, kind, frame_i, frame_j, body, why, prev_hash, hash"


class NothingToUndo(StoreError):
    """Undo, redo or withdrawal with nothing left to undo, redo or withdraw."""


class JournalChanged(StoreError):
    """Another reviewer added a decision meanwhile."""


@dataclass(frozen=True, slots=True)
class JournalRow:
    """A row of the journal; the fields are the columns."""

    seq: int
    """Counts from 1 without holes."""
    time: str
    """UTC, ISO 8601 with milliseconds."""
    who: str
    kind: str
    frame_i: int | None
    frame_j: int | None
    body: str
    """JSON text, see `Decision.body`."""
    why: str
    prev_hash: str
    hash: str

    def sealed(self) -> str:
        """The hash this row must have."""
        fields = [self.seq, self.time, self.who, self.kind, self.frame_i, self.frame_j, self.body]
        return hash_json([*fields, self.why, self.prev_hash])

    def decision(self) -> Decision:
        """The decision of this row.

        Raises:
            StoreError: If the row is no decision.
        """
        pair = (
            None if self.frame_i is None or self.frame_j is None else (self.frame_i, self.frame_j)
        )
        try:
            body = json.loads(self.body)
        except ValueError as error:
            raise StoreError(
                CodedText("journal-row-damaged", row=self.seq, why=text_of(error))
            ) from error
        found = Decision.of(self.kind, self.who, self.why, pair=pair, body=body)
        return replace(found, time=self.time)


def read_rows(root: Path) -> list[JournalRow]:
    """All rows of a project, oldest first; none if there is no journal.

    Raises:
        StoreError: If the file is damaged.
    """
    path = root / NAME
    if not path.exists():
        return []
    with _database(path) as db:
        return _rows(db)


def read_decided(root: Path) -> Decided:
    """The decisions in force in a project.

    Raises:
        StoreError: If the journal is damaged.
    """
    return fold(row.decision() for row in read_rows(root))


def append(
    root: Path,
    decision: Decision,
    *,
    after_seq: int | None = None,
    seen_seq: int | None = None,
) -> JournalRow:
    """Append a row; it is on disk when this returns.

    Args:
        root: The project folder.
        decision: The new decision.
        after_seq: Required number of the last row; None = any.
        seen_seq: Last row that the person saw; None = not known: a decision of another person
            about the same pair is never replaced then.

    Raises:
        NothingToUndo: If there is no decision to undo or redo, or no such correction.
        JournalChanged: If the last row is not ``after_seq`` (an undo or redo passes over rows that
            change no decision), somebody decided about the same pair or corrected classes after
            ``seen_seq``, or the same correction is there already.
        StoreError: If the file is damaged or cannot be written (`NoSpace`: disk full).
    """
    with changing(root, NAME), _database(root / NAME, write=True) as db:
        db.execute("BEGIN IMMEDIATE")  # no other writer from here on
        rows = _rows(db)
        _check(rows, decision, after_seq)
        _check_unseen(rows[seen_seq or 0 :], decision, seen=seen_seq is not None)
        row = _next(rows, decision)
        db.execute(
            f"INSERT INTO journal ({_COLUMNS}) VALUES (?,?,?,?,?,?,?,?,?,?)",
            tuple(getattr(row, name) for name in _COLUMNS.split(", ")),
        )
        db.execute("COMMIT")
        merge_log(db)
    return row


def broken(rows: Sequence[JournalRow]) -> list[str]:
    """Problems of the hash chain; empty = intact."""
    problems: list[str] = []
    before = CHAIN_START
    for place, row in enumerate(rows, start=1):
        if row.seq != place:
            problems.append(CodedText("journal-row-missing", row=place))
            break
        if row.prev_hash != before:
            problems.append(CodedText("journal-row-follows", row=place))
        if row.sealed() != row.hash:
            problems.append(
                CodedText("journal-row-changed", row=place, kind=str(row.kind), who=row.who)
            )
        before = row.hash
    return problems


def head(rows: Sequence[JournalRow]) -> str:
    """Hash of the last row."""
    return rows[-1].hash if rows else CHAIN_START


def _check(rows: Sequence[JournalRow], decision: Decision, after_seq: int | None) -> None:
    steps = decision.kind in (DecisionKind.UNDO, DecisionKind.REDO)
    if after_seq is not None and after_seq != len(rows):
        unseen = [row for row in rows[after_seq:] if not steps or row.kind not in ABOUT_WORK]
        if unseen or after_seq > len(rows):
            raise JournalChanged(CodedText("decided-meanwhile", count=len(unseen)))
    if steps:
        decided = fold(row.decision() for row in rows)
        left = decided.undoable if decision.kind is DecisionKind.UNDO else decided.redoable
        if not left:
            raise NothingToUndo(CodedText("nothing-to-undo", step=str(decision.kind)))
    if decision.kind in ABOUT_CLASSES:
        _check_correction(fold(row.decision() for row in rows), decision)


def _check_correction(decided: Decided, decision: Decision) -> None:
    """Withdraw only what is in force, and decide nothing twice."""
    there = {one.id: one for one in decided.corrections}
    if decision.correction is None:
        if decision.withdraws not in there:
            raise NothingToUndo(CodedText("correction-not-in-force", id=str(decision.withdraws)))
        return
    same = there.get(correction_id(decision.correction))
    if same is not None:
        raise JournalChanged(CodedText("correction-made-already", who=same.who))


def _check_unseen(unseen: Sequence[JournalRow], decision: Decision, *, seen: bool) -> None:
    """Reject a decision about what was decided meanwhile, in another window or by another person.

    Args:
        unseen: Rows that the person did not see; all if it is not known what they saw.
        decision: The new decision.
        seen: Whether it is known what they saw; else their own decisions do not count.
    """
    for row in reversed(unseen):
        mine = row.who == decision.who
        if decision.kind in VERDICTS and _is_verdict_on(row, decision.pair) and (seen or not mine):
            raise JournalChanged(
                CodedText("pair-decided-by-you", kind=row.kind)
                if mine
                else CodedText("pair-decided", who=row.who, kind=row.kind)
            )
        if seen and decision.correction is not None and row.kind in _CHANGE_CLASSES and not mine:
            raise JournalChanged(CodedText("corrections-changed", who=row.who, kind=row.kind))


def _is_verdict_on(row: JournalRow, pair: Pair | None) -> bool:
    return row.kind in VERDICTS and (row.frame_i, row.frame_j) == pair


def _next(rows: Sequence[JournalRow], decision: Decision) -> JournalRow:
    frame_i, frame_j = decision.pair or (None, None)
    row = JournalRow(
        seq=len(rows) + 1,
        time=datetime.now(UTC).isoformat(timespec="milliseconds"),
        who=decision.who,
        kind=str(decision.kind),
        frame_i=frame_i,
        frame_j=frame_j,
        body=json.dumps(decision.body(), separators=(",", ":"), allow_nan=False),
        why=decision.why,
        prev_hash=head(rows),
        hash="",
    )
    return replace(row, hash=row.sealed())


def _rows(db: sqlite3.Connection) -> list[JournalRow]:
    return [
        JournalRow(*values) for values in db.execute(f"SELECT {_COLUMNS} FROM journal ORDER BY seq")
    ]


@contextmanager
def _database(path: Path, *, write: bool = False) -> Iterator[sqlite3.Connection]:
    db: sqlite3.Connection | None = None
    try:
        if not write and not has_room_beside(path):
            db = connect_to_read(path)
            yield db
            return
        if write:
            create_whole(path, _SCHEMA)
        db = connect(path)
        if write:
            make_durable(db)
            db.executescript(_SCHEMA)
        else:
            sync_commits(db)  # the last connection to close merges the log
        yield db
    except sqlite3.Error as error:
        raise_if_full(error, path)
        raise StoreError(
            CodedText("journal-damaged", file=str(path), why=text_of(error))
        ) from error
    finally:
        if db is not None:
            db.close()  # what was not committed is rolled back
