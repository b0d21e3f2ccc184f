"""Verification of a project: hash chain of the journal, signatures and files of its approvals."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, at, text_of
from recon4.model.usability import Usability
from recon4.progress import Progress, track
from recon4.review.approved import VERSIONS, Approval, read_approval, versions_without_row
from recon4.review.decisions import DecisionKind
from recon4.review.journal import broken, read_rows
from recon4.review.newest_approval import refuse_older
from recon4.review.trusted_keys import TrustedKey, UnknownSigner, trusted_for
from recon4.store.checked import Altered
from recon4.store.damage import other_names
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
    damaged: list[str] = [at("journal", one) for one in broken(rows)]
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
            damaged.append(CodedText("damage-version", version=version, what=text_of(error)))
            continue
        wrong = _files(folder, dict(approval.issued))
        damaged += [CodedText("damage-version", version=version, what=one) for one in wrong]
        try:
            key = trusted.signer(public_key)
        except UnknownSigner as error:
            who = visible(approval.stamp.who)
            untrusted.append(
                CodedText("approval-untrusted", version=version, who=who, why=text_of(error))
            )
            continue
        if not wrong:
            approvals.append(_approved(approval, key))
    damaged += [
        CodedText("approval-no-row", name=name) for name in versions_without_row(root, rows)
    ]
    try:
        refuse_older(root, rows)
    except StoreError as error:
        damaged.append(text_of(error))
    return VerifiedReview(len(rows), tuple(approvals), tuple(damaged), tuple(untrusted))


def _approved(approval: Approval, key: TrustedKey) -> str:
    stamp = approval.stamp
    return CodedText(
        "approval-valid",
        version=stamp.version,
        who=visible(stamp.who),
        time=stamp.time,
        fingerprint=key.fingerprint,
        name=visible(key.name),
        verdict="none" if stamp.verdict in ("", Usability.GOOD) else stamp.verdict,
        why=visible(" ".join(stamp.why.split())) or "none",
    )


def _files(folder: Path, issued: dict[str, object]) -> list[str]:
    there = {path.name for path in folder.iterdir()} - {"approval.json"}
    both = sorted(there & issued.keys())
    altered = [one for one in both if hash_file(folder / one) != issued[one]]
    return other_names(there, issued) + [CodedText("damage-bytes", name=one) for one in altered]
