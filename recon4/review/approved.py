"""Finds valid approvals: compared with the journal, their signature and the trusted keys."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from recon4.locales.coded import CodedText, text_of
from recon4.review.decisions import (
    DecisionKind,
)
from recon4.review.evidence import Evidence
from recon4.review.journal import JournalRow, broken, read_rows
from recon4.review.newest_approval import refuse_older
from recon4.review.row_contents import ApprovalFacts
from recon4.review.signature import fingerprint, has_valid_signature
from recon4.review.stamp import Stamp
from recon4.review.state import artifact_keys, read_summary
from recon4.review.trusted_keys import UnknownSigner, trusted_for
from recon4.store.checked import Altered, check_file
from recon4.store.hashing import FileDigest, hash_json

VERSIONS = "versions"


@dataclass(frozen=True, slots=True)
class Approval:
    """A valid approval: journal row, statement and signature agree, and the signer is trusted."""

    version: int
    hash: str
    """SHA-256 of the statement."""
    folder: Path
    """Folder of the issued files."""
    stamp: Stamp
    artifacts: Mapping[str, str]
    """Stage -> key of the approved artifact."""
    manifests: Mapping[str, str]
    """Stage -> SHA-256 of the manifest of its artifact; empty before statement format 2."""
    issued: Mapping[str, str]
    """File name -> SHA-256, as signed."""
    decisions: str
    """`Decided.key` of the decisions in the map."""

    @property
    def evidence(self) -> Evidence:
        """Expected hashes of the artifacts."""
        known = self.manifests
        manifests = {stage: known.get(stage, "") for stage in self.artifacts}
        return Evidence(self.stamp, self.artifacts, manifests)

    def check_issued(self) -> None:
        """Compare every issued file with its hash; an unchanged file is not read again.

        Raises:
            Altered: If a file is missing or has other bytes.
        """
        for name in self.issued:
            self.check_issued_file(self.folder / name)

    def check_issued_file(self, path: Path) -> None:
        """Compare a file in any folder with the issued file of the same name.

        Raises:
            Altered: If no such file was issued, or this one is missing or has other bytes.
        """
        if path.name not in self.issued:
            raise Altered(CodedText("approved-not-issued", file=path.name, version=self.version))
        try:
            size = path.stat().st_size
        except OSError as error:
            raise Altered(
                CodedText("approved-unreadable", file=path.name, why=f"{error.strerror}")
            ) from error
        try:
            check_file(path, FileDigest(size, self.issued[path.name], b""))
        except Altered as error:
            raise Altered(
                CodedText("approved-refused", what=self.evidence.refusal, why=text_of(error))
            ) from error


class NotInJournal(Altered):
    """A project has an approval that is in no row of its journal."""


def approval_of(root: Path, keys: Mapping[str, str]) -> Approval | None:
    """The newest approval of results made of these artifacts; None if there is none.

    Raises:
        Altered: If its file or the journal was changed, its signer is not trusted here
            (`UnknownSigner`), an approval lacks its row in the journal (`NotInJournal`), or the
            project is older than its server's record (`Older`).
        StoreError: If a file cannot be read.
    """
    wanted = hash_json(dict(keys))
    rows = read_rows(root)
    _refuse_without_row(root, rows, keys)
    for row in reversed(rows):
        if row.kind == DecisionKind.APPROVE and _facts(row).artifacts == wanted:
            return _counted(root, rows, row)
    return None


def approval_of_map(root: Path, map_key: str) -> Approval | None:
    """The newest approval of an earlier map, by the key of its artifact.

    Raises:
        Altered: As `approval_of`.
        StoreError: If a file cannot be read.
    """
    rows = read_rows(root)
    _refuse_without_row(root, rows, {})
    for row in reversed(rows):
        if row.kind == DecisionKind.APPROVE:
            approval = _counted(root, rows, row)
            if approval.artifacts.get("map") == map_key:
                return approval
    return None


def newest_counts(root: Path) -> bool:
    """Whether the newest approval in the journal is valid and its signer trusted.

    Raises:
        StoreError: If a file cannot be read, or an approval does not count.
    """
    rows = read_rows(root)
    approving = [row for row in rows if row.kind == DecisionKind.APPROVE]
    return bool(approving and _counted(root, rows, approving[-1]))


def versions_without_row(root: Path, rows: Sequence[JournalRow]) -> list[str]:
    """Folders below ``versions/`` that no row of the journal names, except those set aside."""
    counted = {str(_facts(row).version) for row in rows if row.kind == DecisionKind.APPROVE}
    folder = root / VERSIONS
    names = sorted(path.name for path in folder.iterdir()) if folder.is_dir() else []
    return [
        name for name in names if name not in counted and not name.startswith(("unfinished-", "."))
    ]


def _refuse_without_row(root: Path, rows: Sequence[JournalRow], keys: Mapping[str, str]) -> None:
    """Refuse a project with an approval that its journal does not have.

    Its row was removed, or an older journal was put there, or it was interrupted before its row;
    or the project as a whole is older than what its server recorded.
    """
    refuse_older(root, rows)
    if surplus := versions_without_row(root, rows):
        raise NotInJournal(CodedText("approved-no-row", folder=surplus[-1]))
    summary = read_summary(root) or {}
    stated = summary.get("approval")
    named = stated.get("hash") if isinstance(stated, dict) else stated
    approved = {_facts(row).approval for row in rows if row.kind == DecisionKind.APPROVE}
    if named and named not in approved and artifact_keys(summary) == dict(keys):
        raise NotInJournal(CodedText("approved-named-no-row"))


def read_approval(folder: Path, row: JournalRow) -> tuple[Approval, str]:
    """The approval named by a row of the journal, and the public key that signed it.

    Whether that key is trusted is for the caller to check (`TrustedKeys.signer`).

    Raises:
        Altered: If ``approval.json`` is missing or damaged, is not the one of the row, was signed
            over another journal, or its signature is not valid.
    """
    facts, path = _facts(row), folder / "approval.json"
    try:
        found = json.loads(path.read_text("utf-8"))
        statement, issued, signature = found["statement"], found["issued"], found["signature"]
        key = fingerprint(signature["public_key"])
        stamp = _stamp(facts.version, statement, facts.approval)
        artifacts, manifests = dict(statement["artifacts"]), dict(statement.get("manifests", {}))
        signed_head = statement["journal"]["head"]
        signed = (statement["version"], hash_json(artifacts))
        approval = Approval(
            version=stamp.version,
            hash=stamp.hash,
            folder=folder,
            stamp=stamp,
            artifacts=artifacts,
            manifests=manifests,
            issued=dict(issued),
            decisions=str(statement["journal"]["decisions"]),
        )
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise Altered(
            CodedText("approved-statement-unreadable", folder=folder.name, why=f"{error!r}")
        ) from error
    if hash_json(statement) != stamp.hash or found["hash"] != stamp.hash:
        raise Altered(CodedText("approved-other-statement"))
    if not has_valid_signature({"hash": stamp.hash, "issued": issued}, signature):
        raise Altered(CodedText("approved-signature-invalid"))
    if signature.get("key") != key:
        raise Altered(CodedText("approved-other-key", named=str(signature.get("key")), key=key))
    if signed_head != row.prev_hash:
        raise Altered(CodedText("approved-other-journal"))
    if signed != (facts.version, facts.artifacts) or stamp.who != row.who:
        raise Altered(CodedText("approved-row-differs"))
    return approval, str(signature["public_key"])


def _counted(root: Path, rows: Sequence[JournalRow], row: JournalRow) -> Approval:
    version = str(_facts(row).version)
    if wrong := broken(rows):
        raise Altered(CodedText("approved-journal-altered", what=wrong[0]))
    try:
        approval, public_key = read_approval(root / VERSIONS / version, row)
        trusted_for(root).signer(public_key)
    except UnknownSigner as error:
        raise UnknownSigner(
            CodedText("approved-not-counted", version=version, why=text_of(error)), error.key
        ) from error
    except Altered as error:
        raise Altered(
            CodedText("approved-not-valid", version=version, why=text_of(error))
        ) from error
    return approval


def _facts(row: JournalRow) -> ApprovalFacts:
    facts = row.decision().facts
    if facts is None:
        raise Altered(CodedText("approved-no-hash"))
    return facts


def _stamp(version: int, statement: Mapping[str, Any], sha256: str) -> Stamp:
    who = {name: str(statement[name]) for name in ("who", "role", "time")}
    if "verdict" in statement:  # since format 3
        who |= {"verdict": str(statement["verdict"]["usability"]), "why": str(statement["why"])}
    return Stamp(version=version, hash=sha256, **who)
