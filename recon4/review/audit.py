"""Audit of a project: hash chain of the journal, signatures and files of its approvals."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from recon4.model.usability import Usability
from recon4.names import visible
from recon4.progress import Progress, track
from recon4.review.approved import VERSIONS, read_approval
from recon4.review.decisions import DecisionKind
from recon4.review.journal import JournalRow, broken, read_rows
from recon4.store.checked import Altered
from recon4.store.hashing import hash_file


@dataclass(frozen=True, slots=True)
class ReviewAudit:
    """Result of an audit."""

    rows: int
    """Rows of the journal."""
    approvals: tuple[str, ...]
    """Valid approvals, one line each."""
    damaged: tuple[str, ...]
    """Problems, one line each; empty = none."""


def audit_review(root: Path, progress: Progress) -> ReviewAudit:
    """Check the hash chain of the journal, and signature and files of every approval.

    Raises:
        StoreError: If the journal cannot be read.
    """
    rows = read_rows(root)
    damaged = [f"journal: {what}" for what in broken(rows)]
    approvals, counted = [], set()
    approving = [row for row in rows if row.kind == DecisionKind.APPROVE]
    for row in track(approving, progress, what="approvals", unit="versions"):
        facts = json.loads(row.body)["facts"]
        version = int(facts["version"])
        counted.add(str(version))
        wrong, key = _check(root / VERSIONS / str(version), row)
        damaged += [f"version {version}: {what}" for what in wrong]
        if not wrong:
            signed = f"version {version}, approved by {row.who}, {row.time}, key {key}"
            approvals.append(signed + _in_spite_of(facts.get("verdict", ""), row.why))
    damaged += _surplus(root / VERSIONS, counted)
    return ReviewAudit(len(rows), tuple(approvals), tuple(damaged))


def _in_spite_of(verdict: str, why: str) -> str:
    """The verdict that a map was approved in spite of, and the reason; empty for a good one."""
    if verdict in ("", Usability.GOOD):
        return ""
    return f', verdict "{verdict}"' + (
        f', reason "{visible(" ".join(why.split()))}"' if why else ""
    )


def _check(folder: Path, row: JournalRow) -> tuple[list[str], str]:
    """Problems of a version, and the fingerprint of its key."""
    try:
        approval, key = read_approval(folder, row)
    except Altered as error:
        return [str(error)], ""
    return _files(folder, dict(approval.issued)), key


def _files(folder: Path, issued: dict[str, object]) -> list[str]:
    there = {path.name for path in folder.iterdir()} - {"approval.json"}
    wrong = [f"{name} is missing" for name in sorted(issued.keys() - there)]
    wrong += [f"{name} does not belong here" for name in sorted(there - issued.keys())]
    both: Sequence[str] = sorted(there & issued.keys())
    return wrong + [f"{n} has other bytes" for n in both if hash_file(folder / n) != issued[n]]


def _surplus(folder: Path, counted: set[str]) -> list[str]:
    """Versions without a row in the journal, except interrupted approvals."""
    if not folder.is_dir():
        return []
    names = sorted(path.name for path in folder.iterdir())
    return [
        f"versions/{name} is in no row of the journal"
        for name in names
        if name not in counted and not name.startswith(("unfinished-", "."))
    ]
