"""HTTP routes about acknowledged findings."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter
from pydantic import BaseModel, ConfigDict, Field

from recon4.findings.summary_notes import findings_in
from recon4.locales.coded import CodedText
from recon4.review.acknowledgments import Acknowledgment, acknowledgments, seen_finding
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append, read_rows
from recon4.review.state import read_summary
from recon4_app.access.people import Permission, Person, Who
from recon4_app.deps import Server
from recon4_app.errors import Conflict
from recon4_app.names import Note
from recon4_app.review.model import Finite
from recon4_app.review.routes import LOOK, REVIEW
from recon4_app.review.routes import router as review_router

router = APIRouter(
    prefix=f"{review_router.prefix}/acknowledgments",
    tags=["review"],
    responses=review_router.responses,
)


class NewAcknowledgment(BaseModel):
    """A note about a finding of the map."""

    model_config = ConfigDict(extra="forbid")

    finding: Annotated[int, Field(ge=0, le=100_000)]
    """Its place in the list of findings."""
    kind: Annotated[str, Field(max_length=64)]
    """Code of the finding that the reviewer saw there."""
    span_s: tuple[Finite, Finite] | None = None
    """Its stretch; the request is rejected if the map has another finding there by now."""
    why: Annotated[Note, Field(min_length=1, max_length=500)]
    """The note."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AcknowledgmentsView:
    """The acknowledgments of a project."""

    may_acknowledge: bool
    notes: list[Acknowledgment]
    """Oldest first."""


@router.get("", dependencies=LOOK, summary="Acknowledged findings")
def read_acknowledgments(project_id: str, server: Server, who: Who) -> AcknowledgmentsView:
    """Who acknowledged which finding with which note, and which of them are outdated."""
    return _view(server.projects.folder(project_id), who)


@router.post("", status_code=201, dependencies=REVIEW, summary="Acknowledge a finding")
def acknowledge(
    project_id: str, new: NewAcknowledgment, server: Server, *, who: Who
) -> AcknowledgmentsView:
    """Append a note about a finding to the journal. The verdict on the map does not change."""
    root = server.projects.folder(project_id)
    findings = findings_in(read_summary(root) or {}) or []
    seen = findings[new.finding] if new.finding < len(findings) else None
    if seen is None or (seen.kind, seen.span_s) != (new.kind, new.span_s):
        raise Conflict(CodedText("findings-differ"))
    decision = Decision(
        kind=DecisionKind.ACKNOWLEDGE, who=who.name, why=new.why, finding=seen_finding(seen)
    )
    append(root, decision)
    return _view(root, who)


def _view(root: Path, who: Person) -> AcknowledgmentsView:
    return AcknowledgmentsView(
        may_acknowledge=who.may(Permission.REVIEW),
        notes=acknowledgments(read_rows(root), read_summary(root) or {}),
    )
