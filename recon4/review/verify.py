"""Verification of a project: hash chain of the journal, signatures and files of its approvals."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import StoreError
from recon4.model.usability import Usability
from recon4.progress import Progress, track
from recon4.review.approved import VERSIONS, Approval, read_approval, versions_without_row
from recon4.review.decisions import DecisionKind
from recon4.review.journal import broken, read_rows
from recon4.review.newest_approval import refuse_older
from recon4.review.trusted_keys import TrustedKey, UnknownSigner, trusted_for
from recon4.store.checked import Altered
from recon4.store.hashing import hash_file
from recon4.untrusted.names import visible


@dataclass(frozen=True, slots=True)
class VerifiedReview:
    """Result of a verification."""

    rows: int
    """Rows of the journal."""
    approvals: tuple[str, ...]
    """Valid approvals, one line each."""
    damaged: tuple[str, ...]
    """Problems, one line each; empty = none."""
    untrusted: tuple[str, ...]
    """Approvals whose signature is intact and whose signer is not trusted here, one line each."""


def verify_review(root: Path, progress: Progress) -> VerifiedReview:
    """Check the hash chain of the journal, and signature and files of every approval.

    Raises:
        StoreError: If the journal cannot be read.
    """
    rows, trusted = read_rows(root), trusted_for(root)
    damaged = [f"journal: {what}" for what in broken(rows)]
    approvals: list[str] = []
    untrusted: list[str] = []
    approving = [row for row in rows if row.kind == DecisionKind.APPROVE]
    for row in track(approving, progress, what="approvals", unit="versions"):
        facts = json.loads(row.body)["facts"]
        version = int(facts["version"])
        folder = root / VERSIONS / str(version)
        try:
            approval, public_key = read_approval(folder, row)
        except Altered as error:
            damaged.append(f"version {version}: {error}")
            continue
        wrong = _files(folder, dict(approval.issued))
        damaged += [f"version {version}: {what}" for what in wrong]
        try:
            key = trusted.signer(public_key)
        except UnknownSigner as error:
            untrusted.append(f"version {version} by {visible(approval.stamp.who)}: {error}")
            continue
        if not wrong:
            approvals.append(_approved(approval, key))
    damaged += [
        f"versions/{name} is in no row of the journal: the row was removed, the journal is an "
        "older one, or the approval was interrupted"
        for name in versions_without_row(root, rows)
    ]
    try:
        refuse_older(root, rows)
    except StoreError as error:
        damaged.append(str(error))
    return VerifiedReview(len(rows), tuple(approvals), tuple(damaged), tuple(untrusted))


def _approved(approval: Approval, key: TrustedKey) -> str:
    stamp = approval.stamp
    signed = f"version {stamp.version}, approved by {visible(stamp.who)}, {stamp.time}"
    by = f", key {key.fingerprint} ({visible(key.name)})"
    return signed + by + _in_spite_of(stamp.verdict, stamp.why)


def _in_spite_of(verdict: str, why: str) -> str:
    """The verdict that a map was approved in spite of, and the reason; empty for a good one."""
    if verdict in ("", Usability.GOOD):
        return ""
    return f', verdict "{verdict}"' + (
        f', reason "{visible(" ".join(why.split()))}"' if why else ""
    )


def _files(folder: Path, issued: dict[str, object]) -> list[str]:
    there = {path.name for path in folder.iterdir()} - {"approval.json"}
    wrong = [f"{name} is missing" for name in sorted(issued.keys() - there)]
    wrong += [f"{name} does not belong here" for name in sorted(there - issued.keys())]
    both: Sequence[str] = sorted(there & issued.keys())
    return wrong + [f"{n} has other bytes" for n in both if hash_file(folder / n) != issued[n]]
