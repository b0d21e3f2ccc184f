"""Approval: a signed statement about a finished run, and an unchangeable copy of its results.

``versions/<n>/approval.json`` contains the statement, its SHA-256, the hashes of the issued files,
and an Ed25519 signature over both. It is valid once its row is in the journal, written last.
"""

from __future__ import annotations

import json
import secrets
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, TypedDict

import msgspec

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, text_of, unreadable
from recon4.model.usability import MapVerdict, Usability, verdict_in
from recon4.review.acknowledgments import signed_acknowledgments, write_into_report
from recon4.review.approved import VERSIONS, Approval, approval_of, versions_without_row
from recon4.review.decisions import (
    Decided,
    Decision,
    DecisionKind,
    fold,
)
from recon4.review.journal import JournalRow, append, broken, head, read_rows
from recon4.review.row_contents import ApprovalFacts
from recon4.review.signature import sign
from recon4.review.source import graph_key
from recon4.review.stamp import NO_VERDICT, Stamp, stamp_file
from recon4.review.state import artifact_keys, decisions_in_map, read_summary
from recon4.review.teamwork import second_opinion_missing
from recon4.review.tuning import APPROVALS
from recon4.store.atomic import atomic_folder, link_file, make_folders, sweep, write_json
from recon4.store.checked import Altered, CheckedArtifact
from recon4.store.formats import FORMATS
from recon4.store.hashing import hash_file, hash_json
from recon4.store.project import SUMMARY, Project
from recon4.store.seal import changing, check_sealed

_FIGURES = (
    "points",
    "path_length_m",
    "duration_s",
    "multiframes",
    "lost",
    "edges",
    "crs",
    "rig_origin",
    "corrections",
    "warnings",  # before format 3 of the summary
    "findings",
)


class NotApprovable(StoreError):
    """The results cannot be approved as they are."""


class SignedVerdict(TypedDict):
    """`MapVerdict` as JSON in a statement."""

    usability: str
    """`NO_VERDICT` if the run worked none out."""
    reasons: list[str]
    unobserved: list[object]


class SignedJournal(TypedDict):
    """The journal at the time of an approval, as JSON in its statement."""

    rows: int
    head: str
    decisions: str
    """`Decided.key`."""


class ApprovalStatement(TypedDict):
    """What is signed, as JSON in format `FORMATS.approval`."""

    format: int
    project: str
    version: int
    who: str
    role: str
    why: str
    time: str
    verdict: SignedVerdict
    figures: dict[str, object]
    """By their names in ``summary.json``, with ``chi2`` and ``conflicts``."""
    artifacts: dict[str, str]
    """Stage -> key."""
    manifests: dict[str, str]
    """Stage -> SHA-256 of its manifest."""
    inputs: dict[str, str]
    """File name -> SHA-256."""
    results: dict[str, str]
    journal: SignedJournal
    acknowledgments: list[dict[str, object]]
    """Notes of reviewers about findings of this map, fields of `Acknowledgment`; since format 4."""


@dataclass(frozen=True, slots=True)
class _ApprovalRequest:
    """Results to approve, and the signer."""

    summary: dict[str, Any]
    decided: Decided
    rows: Sequence[JournalRow]
    signer: Mapping[str, str]
    conflicts: int
    verdict: MapVerdict | None
    """On the map; None = the run worked none out."""

    @property
    def keys(self) -> dict[str, str]:
        return artifact_keys(self.summary)


def approve(
    root: Path,
    key_file: Path,
    signer: Mapping[str, str],
    *,
    confirmed: bool,
    seen: tuple[int | None, str | None] = (None, None),
) -> Approval:
    """Sign the results of a project and store them as a new version.

    Args:
        root: The project folder; it is locked meanwhile.
        key_file: Private key of the server; made when it is missing.
        signer: ``who``, ``role`` and ``why``.
        confirmed: Sign although accepted loop closures do not fit; needs a reason.
        seen: Number of journal rows and key of the graph that the signer saw; None = not checked.

    Raises:
        NotApprovable: If there is no finished run, it lacks decisions, is damaged, has conflicts
            that are not confirmed with a reason, lacks a second opinion that was asked for, is
            approved already, differs from what the signer saw, or its verdict needs a reason
            (`reason_needed`).
        StoreError: If the project is in use or cannot be written (`NoSpace`: disk full).
    """
    with Project.open(root):
        asked = _asked(root, signer)
        if seen[0] not in (None, len(asked.rows)) or seen[1] not in (None, graph_key(root)):
            raise NotApprovable(CodedText("approve-map-changed"))
        _refuse_again(root, asked)
        _refuse(root, asked, confirmed=confirmed)
        make_folders(root / VERSIONS)
        sweep(root / VERSIONS)
        version = 1 + sum(row.kind == DecisionKind.APPROVE for row in asked.rows)
        approval = _issue(root, asked, version=version, key_file=key_file)
        facts = ApprovalFacts(
            version=version,
            approval=approval.hash,
            artifacts=hash_json(asked.keys),
            verdict=approval.stamp.verdict,
        )
        decision = Decision(
            kind=DecisionKind.APPROVE, who=signer["who"], why=signer["why"], facts=facts
        )
        append(root, decision, after_seq=len(asked.rows))
        _hand_out(root, approval)
    return approval


def reason_needed(verdict: MapVerdict | None) -> CodedText | None:
    """Why a map with this verdict is approved only with a typed reason; None = without one."""
    if verdict is None:
        return CodedText("reason-no-verdict")
    if verdict.usability is Usability.DO_NOT_USE:
        return CodedText("reason-do-not-use", reasons=" ".join(verdict.reasons))
    if verdict.unobserved:
        return CodedText("reason-not-observable", count=len(verdict.unobserved))
    return None


def signed_figures(summary: Mapping[str, object]) -> dict[str, object]:
    """The figures of a run that an approval signs, by their names in ``summary.json``."""
    return {name: summary[name] for name in _FIGURES if name in summary}


def put_back(root: Path, approval: Approval) -> None:
    """Restore the issued results in the project folder.

    Raises:
        Altered: If a file of the version differs from the signed one; nothing is restored.
    """
    approval.check_issued()
    for path in sorted(approval.folder.iterdir()):
        if path.name not in ("approval.json", "summary.json"):
            link_file(path, root / path.name)


def make_read_only(approval: Approval) -> None:
    """Protect issued files from accidental changes; deliberate ones are found by their hash.

    A sandboxed process may not change file modes, so the caller of `approve` does this.
    """
    for path in approval.folder.iterdir():
        path.chmod(0o444)


def _hand_out(root: Path, approval: Approval) -> None:
    """Replace the results and the summary of the project by the issued ones."""
    with changing(root, SUMMARY, compared=False):
        put_back(root, approval)
        link_file(approval.folder / SUMMARY, root / SUMMARY)


def _refuse_again(root: Path, asked: _ApprovalRequest) -> None:
    """Reject a second approval of the same results; complete an interrupted one first.

    A version that was altered since is invalid, and the results may be approved again.
    """
    try:
        before = approval_of(root, asked.keys)
        if before is None:
            return
        if (asked.summary.get("approval") or {}).get("hash") != before.hash:
            _hand_out(root, before)
    except Altered:
        return
    raise NotApprovable(CodedText("approve-again", version=before.version, who=before.stamp.who))


def _asked(root: Path, signer: Mapping[str, str]) -> _ApprovalRequest:
    summary = read_summary(root)
    if summary is None:
        raise NotApprovable(CodedText("approve-no-map"))
    try:
        check_sealed(root, SUMMARY)
    except Altered as error:
        raise NotApprovable(CodedText("approve-damaged", detail=text_of(error))) from error
    rows = read_rows(root)
    if record := broken(rows):
        raise NotApprovable(CodedText("approve-journal-altered", detail=record[0]))
    decided = fold(row.decision() for row in rows)
    return _ApprovalRequest(
        summary,
        decided,
        rows,
        signer,
        conflicts=_conflicts(root, summary),
        verdict=_verdict(summary),
    )


def _verdict(summary: Mapping[str, object]) -> MapVerdict | None:
    try:
        return verdict_in(summary)
    except StoreError as error:
        raise NotApprovable(CodedText("approve-damaged", detail=text_of(error))) from error


def _conflicts(root: Path, summary: dict[str, Any]) -> int:
    key = artifact_keys(summary).get("review")
    if key is None:
        return 0
    path = root / "artifacts" / key / "review.json"
    try:
        return len(json.loads(path.read_text("utf-8"))["conflicts"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise StoreError(unreadable(str(path), error)) from error


def _refuse(root: Path, asked: _ApprovalRequest, *, confirmed: bool) -> None:
    _refuse_without_decisions(root, asked.decided)
    if missing := second_opinion_missing(row.decision() for row in asked.rows):
        raise NotApprovable(missing)
    if asked.conflicts and not (confirmed and asked.signer["why"].strip()):
        raise NotApprovable(CodedText("approve-conflicts", count=asked.conflicts))
    why_not, characters = reason_needed(asked.verdict), APPROVALS.min_reason_characters
    if why_not is not None and len(asked.signer["why"].strip()) < characters:
        raise NotApprovable(
            CodedText(f"approve-{why_not.code}", characters=characters, **why_not.values)
        )
    for name, sha256 in asked.summary["hashes"]["results"].items():
        path = root / name
        if not path.is_file() or hash_file(path) != sha256:
            raise NotApprovable(CodedText("approve-other-result", file=name))
    try:
        for key in asked.keys.values():
            CheckedArtifact.open(root / "artifacts" / key).check_all()
    except Altered as error:
        raise NotApprovable(CodedText("approve-damaged", detail=text_of(error))) from error


def _refuse_without_decisions(root: Path, decided: Decided) -> None:
    try:
        is_current = decisions_in_map(root) == decided.key
    except StoreError as error:
        raise NotApprovable(CodedText("approve-damaged", detail=text_of(error))) from error
    if not is_current:
        raise NotApprovable(CodedText("approve-decisions-missing"))


def _issue(root: Path, asked: _ApprovalRequest, *, version: int, key_file: Path) -> Approval:
    """Write ``versions/<n>/``; it is valid once its row is in the journal."""
    folder = root / VERSIONS / str(version)
    for name in versions_without_row(root, asked.rows):  # of approvals that never were valid
        (root / VERSIONS / name).rename(
            root / VERSIONS / f"unfinished-{name}-{secrets.token_hex(3)}"
        )
    time = datetime.now(UTC).isoformat(timespec="seconds")
    statement = _statement(root, asked, version=version, time=time)
    stamp = Stamp(
        version=version,
        who=asked.signer["who"],
        role=asked.signer["role"],
        time=time,
        hash=hash_json(statement),
        verdict=statement["verdict"]["usability"],
        why=statement["why"],
    )
    with atomic_folder(folder) as made:
        for name in asked.summary["hashes"]["results"]:
            stamp_file(root / name, made / name, stamp)
        write_into_report(made / "report.html", statement["acknowledgments"])
        _write_summary(made, asked.summary, stamp)
        issued = {path.name: hash_file(path) for path in sorted(made.iterdir())}
        signature = sign({"hash": stamp.hash, "issued": issued}, key_file)
        record = {"statement": statement, "hash": stamp.hash, "issued": issued}
        write_json(made / "approval.json", record | {"signature": signature})
    return Approval(
        version=version,
        hash=stamp.hash,
        folder=folder,
        stamp=stamp,
        artifacts=asked.keys,
        manifests=statement["manifests"],
        issued=issued,
        decisions=statement["journal"]["decisions"],
    )


def _statement(
    root: Path, asked: _ApprovalRequest, *, version: int, time: str
) -> ApprovalStatement:
    summary = asked.summary
    figures = signed_figures(summary)
    last = {stage["stage"]: stage.get("figures", {}) for stage in summary["stages"]}
    graph = last.get("review") or last.get("verification", {})
    return {
        "format": FORMATS.approval,
        "project": summary["name"],
        "version": version,
        "who": asked.signer["who"],
        "role": asked.signer["role"],
        "why": asked.signer["why"],
        "time": time,
        "verdict": _judged(asked.verdict),
        "figures": figures | {"chi2": graph.get("chi2_after"), "conflicts": asked.conflicts},
        "artifacts": asked.keys,
        "manifests": {
            stage: hash_file(root / "artifacts" / key / "manifest.json")
            for stage, key in asked.keys.items()
        },
        "inputs": summary["hashes"]["inputs"],
        "results": summary["hashes"]["results"],
        "journal": {
            "rows": len(asked.rows),
            "head": head(asked.rows),
            "decisions": asked.decided.key,
        },
        "acknowledgments": signed_acknowledgments(asked.rows, summary),
    }


def _judged(verdict: MapVerdict | None) -> SignedVerdict:
    """The verdict as signed; `NO_VERDICT` as usability if the run worked none out."""
    if verdict is None:
        return {"usability": NO_VERDICT, "reasons": [], "unobserved": []}
    record: SignedVerdict = msgspec.to_builtins(verdict)
    return record


def _write_summary(folder: Path, summary: dict[str, Any], stamp: Stamp) -> None:
    """Write the summary with the hashes of the issued files."""
    hashes = {path.name: hash_file(path) for path in sorted(folder.iterdir())}
    record = dict(summary) | {"approval": json.loads(stamp.json_line())}
    record["hashes"] = dict(summary["hashes"]) | {"results": hashes}
    write_json(folder / "summary.json", record)
