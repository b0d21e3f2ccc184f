"""Read every byte of a project, or of a folder of projects and its server's state, again."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import Recon4Error, StoreError
from recon4.locales.coded import CodedText, at, text_of
from recon4.progress import Progress
from recon4.review.newest_approval import APPROVALS, accept_as_it_is
from recon4.review.trusted_keys import SIGNING_KEY, STATE, TRUSTED_KEYS
from recon4.review.verify import verify_review
from recon4.store.hashing import files_below
from recon4.store.project import is_project, loose_files
from recon4.store.seal import (
    LOCK,
    OPEN,
    SEALS,
    TURN,
    adopt,
    begin_change,
    changing,
    end_change,
    read_seals,
)
from recon4.store.verify import LATER_FOLDERS, verify_files, verify_seals
from recon4.untrusted.limits import LIMITS

STATE_FILES = (
    "jobs.sqlite",
    "access.sqlite",
    "metrics.token",
    SIGNING_KEY,
    TRUSTED_KEYS,
    APPROVALS,
    "tls",
    "cluster",
    "workers.json",
    "uploads",
    "backups",
)
"""Files of the server's state that are sealed when it ends; thumbnails and logs are not."""
_UNREADABLE = (Recon4Error, ValueError, KeyError, TypeError, AttributeError, OverflowError)
"""What a damaged file may lead to where its content is read."""


@dataclass(frozen=True, slots=True)
class Verified:
    """What was found."""

    checked: int
    damaged: tuple[str, ...]
    """Differences found; empty = none."""
    unknown: tuple[str, ...]
    """Folders that no stage accounts for."""
    notes: tuple[str, ...]
    """What could not be compared by hash, and why."""
    rows: int
    """Of journals."""
    approvals: tuple[str, ...]
    """Descriptions of the valid approvals."""
    untrusted: tuple[str, ...] = ()
    """Approvals with an intact signature of a signer who is not trusted here."""


def verify(path: Path, progress: Progress) -> Verified:
    """Verify a project, or every project and the server's state below a folder.

    Raises:
        StoreError: If the folder is neither.
    """
    if is_project(path) or not (path / STATE).is_dir():
        return verify_project(path, progress)
    projects = sorted(entry for entry in path.iterdir() if is_project(entry))
    trash = path / STATE / "trash"
    projects += sorted(e for e in trash.iterdir() if is_project(e)) if trash.is_dir() else []
    found = [_named(verify_project(one, progress), one.relative_to(path)) for one in projects]
    found.append(_named(verify_state(path / STATE), Path(STATE)))
    return Verified(
        checked=sum(one.checked for one in found),
        damaged=tuple(words for one in found for words in one.damaged),
        unknown=tuple(words for one in found for words in one.unknown),
        notes=tuple(words for one in found for words in one.notes),
        rows=sum(one.rows for one in found),
        approvals=tuple(words for one in found for words in one.approvals),
        untrusted=tuple(words for one in found for words in one.untrusted),
    )


def verify_project(root: Path, progress: Progress) -> Verified:
    """Compare hashes and seals, the chain of the journal, and the signatures of approvals.

    Raises:
        StoreError: If the folder is not a project.
    """
    found = verify_files(root, progress)
    damaged = list(found.damaged)
    rows = 0
    approvals: tuple[str, ...] = ()
    untrusted: tuple[str, ...] = ()
    try:
        review = verify_review(root, progress)
        rows, approvals, untrusted = review.rows, review.approvals, review.untrusted
        damaged += review.damaged
    except _UNREADABLE as error:
        why = text_of(error)
        damaged.append(CodedText("cannot-read", file="decisions.sqlite", why=why))
    damaged = list(dict.fromkeys(damaged))
    return Verified(
        checked=found.checked + rows,
        damaged=tuple(damaged),
        unknown=found.unknown,
        notes=found.notes,
        rows=rows,
        approvals=approvals,
        untrusted=untrusted,
    )


def verify_state(state: Path) -> Verified:
    """Compare the server's own files: queue, people, keys, uploads."""
    checked, damaged, notes = verify_seals(state, state_files(state))
    return Verified(checked, tuple(damaged), (), tuple(notes), 0, ())


def state_files(state: Path) -> list[str]:
    """Files of the state that a seal covers, as far as they are there."""
    found = []
    for name in STATE_FILES:
        path = state / name
        inside = [f"{name}/{one}" for one in files_below(path)] if path.is_dir() else [name]
        found += [one for one in inside if _is_small_file(state / one)]
    for outcome in sorted(state.glob("jobs/*/outcome.json")):  # its worker writes no more
        names = ("request.json", "outcome.json", "events.jsonl", "log.txt")
        inside = [f"jobs/{outcome.parent.name}/{name}" for name in names]
        found += [one for one in inside if _is_small_file(state / one)]
    return found


def open_state(state: Path) -> tuple[str, ...]:
    """Mark the server's files as about to change; for its start.

    Returns:
        Descriptions of what differs from the server's last state.
    """
    damaged = verify_state(state).damaged
    if damaged and not _seals_hold(state):
        (state / SEALS).rename(state / f"{SEALS}.damaged")
    names = tuple({*read_seals(state), *state_files(state)})
    begin_change(state, names, compared=False)
    return damaged


def seal_state(state: Path) -> None:
    """Seal the server's files; called at its end, after the last write."""
    end_change(state, tuple({*read_seals(state), *state_files(state)}))


@contextmanager
def state_change(state: Path, *names: str) -> Iterator[None]:
    """Change files of the state; where a server runs, it seals the files when it ends."""
    seals = read_seals(state)
    if not seals or OPEN in seals.values():
        yield
        return
    with changing(state, *names):
        yield


def _seals_hold(state: Path) -> bool:
    try:
        read_seals(state)
    except StoreError:
        return False
    return True


def accept(path: Path) -> Path | None:
    """Seal the files of a project, or of a server's state, as they are now.

    A project that is older than what its server approved is taken as it is.

    Returns:
        The state of the server if its record of that approval was changed.

    Raises:
        StoreError: If it is neither a project nor a folder of projects.
    """
    if (path / STATE).is_dir() and not is_project(path):
        (path / STATE / SEALS).unlink(missing_ok=True)
        seal_state(path / STATE)
        return None
    if not is_project(path):
        raise StoreError(CodedText("not-a-project", file=str(path)))
    (path / SEALS).unlink(missing_ok=True)
    later = [f"{one}/{name}" for one in LATER_FOLDERS for name in files_below(path / one)]
    journal = ["decisions.sqlite"] if (path / "decisions.sqlite").exists() else []
    adopt(path, [*loose_files(path), *journal, *later])
    return accept_as_it_is(path)


def _is_small_file(path: Path) -> bool:
    ours = path.name not in (LOCK, TURN, SEALS, "lock", "pid", "heartbeat")
    return ours and path.is_file() and path.stat().st_size <= LIMITS.json_bytes


def _named(found: Verified, name: Path) -> Verified:
    def with_name(words: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(at(str(name), one) for one in words)

    return Verified(
        found.checked,
        with_name(found.damaged),
        with_name(found.unknown),
        with_name(found.notes),
        found.rows,
        with_name(found.approvals),
        with_name(found.untrusted),
    )
