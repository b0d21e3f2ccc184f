"""The newest approval of each project that a server signed, recorded outside of the project.

A project that is put back as it was earlier, with its journal, versions and seals, is consistent in
itself. The server's record (``ROOT/.recon4/approvals/<folder>.json``) reveals it: the journal no
longer has the recorded row. Where there is no server there is no record, and nothing is compared.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

import msgspec

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, text_of
from recon4.review.decisions import DecisionKind
from recon4.review.journal import JournalRow, read_rows
from recon4.review.trusted_keys import STATE, TRUSTED_KEYS
from recon4.review.tuning import NEWEST_APPROVALS
from recon4.store.atomic import make_folders, write_json
from recon4.store.checked import Altered
from recon4.store.formats import FORMATS
from recon4.store.json_files import read_object
from recon4.untrusted.typed import as_type

APPROVALS = "approvals"


class Older(Altered):
    """A project is older than the newest approval that its server recorded."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NewestApproval:
    """The newest approval of a project."""

    version: int
    row: str
    """Hash of its row in the journal, which covers every row before."""
    time: str
    """Of the row, UTC, ISO 8601."""


def judging_folders(state: Path) -> tuple[Path, Path]:
    """Folders of a server's state that a process reads to judge an approval."""
    return state / TRUSTED_KEYS, state / APPROVALS


def record_path(state: Path, folder_name: str) -> Path:
    """The record of a project, by the name of its folder in ROOT or in the trash."""
    return state / APPROVALS / f"{folder_name}.json"


def refuse_older(root: Path, rows: Sequence[JournalRow]) -> None:
    """Refuse a project whose journal lacks the newest approval that its server recorded.

    Args:
        root: The project folder.
        rows: Its journal.

    Raises:
        Older: If the journal lacks it.
        StoreError: If the record cannot be read.
    """
    root = root.resolve()
    state = _state_of(root)
    recorded = None if state is None else _read(record_path(state, root.name))
    if recorded is None or _has(rows, recorded):
        return
    raise Older(CodedText("approved-older", version=recorded.version, time=recorded.time[:19]))


def record_newest(root: Path, state: Path) -> None:
    """Record the newest approval of a project, unless the project is older than the record.

    Raises:
        StoreError: If the journal or the record cannot be read, or the record not be written.
    """
    rows, path = read_rows(root), record_path(state, root.name)
    newest, recorded = _newest(rows), _read(path)
    if newest is None or newest == recorded or (recorded and not _has(rows, recorded)):
        return
    _write(path, newest)


def replace_record(root: Path, state: Path) -> None:
    """Record the newest approval of a project whatever was recorded; none if there is none.

    Raises:
        StoreError: If the journal cannot be read, or the record not be written.
    """
    newest, path = _newest(read_rows(root)), record_path(state, root.name)
    if newest is None:
        path.unlink(missing_ok=True)
    else:
        _write(path, newest)


def accept_as_it_is(root: Path) -> Path | None:
    """Let the record of a project follow its journal, also to an earlier approval or none.

    Returns:
        The state of the server if its record was replaced; None = nothing was changed.

    Raises:
        StoreError: If the journal cannot be read, or the record not be written.
    """
    root = root.resolve()
    state = _state_of(root)
    if state is None:
        return None
    try:
        refuse_older(root, read_rows(root))
    except StoreError:
        replace_record(root, state)
        return state
    return None


def move_record(state: Path, before: str, after: str) -> None:
    """Let the record follow a folder to another name, as to the trash and back."""
    with suppress(FileNotFoundError):
        record_path(state, before).rename(record_path(state, after))


def _state_of(root: Path) -> Path | None:
    parent = root.parent
    if parent.name == "trash" and parent.parent.name == STATE:
        return parent.parent
    return parent / STATE if (parent / STATE).is_dir() else None


def _newest(rows: Sequence[JournalRow]) -> NewestApproval | None:
    approving = [row for row in rows if row.kind == DecisionKind.APPROVE]
    if not approving:
        return None
    row = approving[-1]
    return NewestApproval(version=len(approving), row=row.sealed(), time=row.time)


def _has(rows: Sequence[JournalRow], recorded: NewestApproval) -> bool:
    return any(row.sealed() == recorded.row for row in rows)


def _read(path: Path) -> NewestApproval | None:
    if not path.exists():
        return None
    record = read_object(path, max_bytes=NEWEST_APPROVALS.max_record_bytes)
    try:
        if record.pop("format", None) != FORMATS.newest_approval:
            raise msgspec.ValidationError(f"expected format {FORMATS.newest_approval}")
        return as_type(record, NewestApproval)
    except msgspec.ValidationError as error:
        raise StoreError(
            CodedText("approved-list-damaged", folder=APPROVALS, file=path.name, why=text_of(error))
        ) from error


def _write(path: Path, newest: NewestApproval) -> None:
    make_folders(path.parent, 0o700)
    write_json(path, {"format": FORMATS.newest_approval, **asdict(newest)})
