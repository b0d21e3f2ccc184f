"""State of the approval of results: what stands beside every file that is offered.

Pages, API and commands show the same line, which is made here and nowhere else.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, StoredText, text_of
from recon4.locales.texts import Shown
from recon4.review.approved import Approval, NotInJournal, approval_of
from recon4.review.decisions import DecisionKind, fold
from recon4.review.journal import JournalRow, read_rows
from recon4.review.newest_approval import Older
from recon4.review.stamp import Stamp
from recon4.review.trusted_keys import UnknownSigner
from recon4.review.tuning import APPROVAL_NAMES
from recon4.store.project import read_artifacts
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.names import visible


class ApprovalKind(StrEnum):
    """Whether results are approved."""

    DRAFT = "draft"
    """Nobody approved them, nor any earlier results."""
    APPROVED = "approved"
    """They are the newest approved version."""
    EARLIER = "earlier"
    """They are an approved version, and a newer one exists."""
    CHANGED = "changed"
    """There is an approved version, and results or decisions are newer than it."""
    UNKNOWN_SIGNER = "unknown signer"
    """The signature is intact, and its key is not trusted here."""
    NOT_VALID = "not valid"
    """An approval or its results were altered, or its row in the journal is missing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ApprovalState:
    """The approval of the results of a project."""

    kind: ApprovalKind
    text: str
    """One line, shown wherever a file of the results is offered."""
    code: str = ""
    """Of that line, to be said in another language; empty = it has none."""
    values: dict[str, int | float | str] = field(default_factory=dict)
    """What the line quotes, by name."""
    detail: str = ""
    """Why it does not count, and what to do; empty if there is no more to say."""
    detail_code: str = ""
    """Of that, to be said in another language; empty = it has none."""
    detail_values: dict[str, int | float | str] = field(default_factory=dict)
    """What it quotes, by name."""
    version: int | None = None
    who: str = ""
    time: str = ""
    """UTC, ISO 8601."""
    hash: str = ""
    """SHA-256 of the signed statement."""
    verdict: str = ""
    """On the map when it was approved; empty before statement format 3."""
    why: str = ""
    """The signer's reason or remark."""
    checking: bool = False
    """Whether the bytes of the results are just being compared with the signed hashes."""

    @property
    def line(self) -> StoredText:
        """The line with its code and values."""
        return StoredText(text=self.text, code=self.code, values=self.values)

    def because(self, why: str) -> ApprovalState:
        """The state with the reason why it does not count."""
        kept = StoredText.of(why)
        shown = visible(kept.text, most=APPROVAL_NAMES.max_detail)
        return replace(self, detail=shown, detail_code=kept.code, detail_values=kept.values)

    def in_language(self, language: str) -> ApprovalState:
        """The state with that reason in a language."""
        kept = StoredText(text=self.detail, code=self.detail_code, values=self.detail_values)
        return replace(self, detail=visible(kept.said(language), most=APPROVAL_NAMES.max_detail))


def _draft(code: str, text: str) -> ApprovalState:
    """The state of a draft; importing this module reads no texts."""
    return ApprovalState(kind=ApprovalKind.DRAFT, text=text, code=code)


NOT_APPROVED = _draft("approval-draft", "Draft: not approved")
WRITTEN_AS_DRAFT = _draft("approval-written-as-draft", "Draft: written without approval")
"""Of a file whose writer asked for that."""


def approval_state(root: Path, keys: Mapping[str, str]) -> ApprovalState:
    """State of the approval of results made of these artifacts.

    Signatures, journal and trusted keys are checked. The bytes of the results are compared when
    they are used (`Approval.check_issued_file`, `Approval.evidence`).

    Args:
        root: The project folder.
        keys: Stage -> key of its artifact.
    """
    try:
        return _state(read_rows(root), approval_of(root, keys))
    except UnknownSigner as error:
        line = CodedText("approval-unknown-key", key=error.key)
        return _state_of(ApprovalKind.UNKNOWN_SIGNER, line).because(text_of(error))
    except Older as error:
        return not_valid(CodedText("approval-older"), error)
    except NotInJournal as error:
        return not_valid(CodedText("approval-not-in-journal"), error)
    except StoreError as error:
        return not_valid(CodedText("approval-invalid"), error)


def latest_state(project: Path, *, draft: bool = False) -> ApprovalState:
    """State of the artifacts of the latest run; `WRITTEN_AS_DRAFT` for a draft.

    Raises:
        StoreError: If the folder is not a project or its ledger is damaged.
    """
    if draft:
        return WRITTEN_AS_DRAFT
    artifacts = read_artifacts(project)
    return approval_state(project, {stage: folder.name for stage, folder in artifacts.items()})


def not_valid(line: CodedText, error: StoreError) -> ApprovalState:
    """The state of an approval that was altered."""
    return _state_of(ApprovalKind.NOT_VALID, line).because(text_of(error))


def altered(state: ApprovalState, why: str) -> ApprovalState:
    """The state when bytes turned out to differ from those that were approved."""
    line = CodedText("approval-altered", version=state.version or 0)
    return _with(state, ApprovalKind.NOT_VALID, line).because(why)


def _state(rows: Sequence[JournalRow], approval: Approval | None) -> ApprovalState:
    approving = [row for row in rows if row.kind == DecisionKind.APPROVE]
    if not approving:
        return NOT_APPROVED
    newest = len(approving)
    if approval is None:
        line = CodedText("approval-changed", version=newest)
        return replace(_state_of(ApprovalKind.CHANGED, line), version=newest)
    stamp = approval.stamp
    signed = _signed(stamp)
    state = replace(
        _state_of(ApprovalKind.APPROVED, CodedText("approval-signed", **signed)),
        version=stamp.version,
        who=visible(stamp.who, most=APPROVAL_NAMES.max_name),
        time=stamp.time,
        hash=stamp.hash,
        verdict=stamp.verdict,
        why=visible(" ".join(stamp.why.split()), most=LIMITS.note),
    )
    if stamp.version < newest:
        line = CodedText("approval-earlier", newest=newest, **signed)
        return _with(state, ApprovalKind.EARLIER, line)
    if approval.decisions != fold(row.decision() for row in rows).key:
        return _with(state, ApprovalKind.CHANGED, CodedText("approval-decided-since", **signed))
    return state


def _state_of(kind: ApprovalKind, line: CodedText) -> ApprovalState:
    return _with(NOT_APPROVED, kind, line)


def _with(state: ApprovalState, kind: ApprovalKind, line: CodedText) -> ApprovalState:
    said = StoredText.of(line)
    return replace(state, kind=kind, text=said.text, code=said.code, values=said.values)


def _signed(stamp: Stamp) -> dict[str, Shown]:
    """Values of the texts about a signed version."""
    who = visible(stamp.who, most=APPROVAL_NAMES.max_name)
    return {"version": stamp.version, "who": who, "day": stamp.time[:10]}
