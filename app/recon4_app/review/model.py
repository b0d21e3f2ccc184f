"""Requests and responses of the review API."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from recon4.findings.summary_notes import SaidFinding
from recon4.model.usability import MapVerdict
from recon4.review.approval_state import ApprovalState
from recon4.review.teamwork import OpinionAgreement, PairWork
from recon4_app.names import Note

Frame = Annotated[int, Field(ge=0, le=1 << 40)]
Finite = Annotated[float, Field(ge=-1e8, le=1e8, allow_inf_nan=False)]
PoseNumbers = Annotated[list[Finite], Field(min_length=7, max_length=7)]
"""x y z [m], quaternion x y z w."""
Why = Annotated[Note, Field(max_length=500)]


class NewDecision(BaseModel):
    """What a person decided about a pair."""

    model_config = ConfigDict(extra="forbid")

    kind: Literal["accept", "reject", "restore", "replace", "add"]
    frame_i: Frame
    """Multiframe of the earlier node."""
    frame_j: Frame
    why: Why = ""
    T_i_j: Annotated[list[Finite], Field(max_length=7)] = []
    """The pose the reviewer saw, x y z qx qy qz qw; empty if there was none."""
    measurement: Annotated[str, Field(max_length=64)] = ""
    """Of ``replace`` and ``add``: the ``measurement`` id that ``align`` returned."""
    seen_seq: Annotated[int | None, Field(ge=0)] = None
    """Last row of the journal that the reviewer saw: reject the request if somebody decided about
    this pair since; null = reject it if another person ever did."""


class Step(BaseModel):
    """Undo or redo."""

    model_config = ConfigDict(extra="forbid")

    after_seq: int | None = None
    """Reject the request unless this is the last row of the journal; null = any row."""
    why: Why = ""


class PredictedPose(BaseModel):
    """Predicted relative pose at which a registration starts."""

    model_config = ConfigDict(extra="forbid")

    frame_i: Frame
    frame_j: Frame
    T_i_j: PoseNumbers


Point = Annotated[list[Finite], Field(min_length=3, max_length=3)]


class PointPairs(BaseModel):
    """Corresponding points picked in two multiframes."""

    model_config = ConfigDict(extra="forbid")

    p_i: Annotated[list[Point], Field(min_length=3, max_length=20)]
    """In the body frame of the first multiframe [m]."""
    p_j: Annotated[list[Point], Field(min_length=3, max_length=20)]
    """In the body frame of the second multiframe [m]."""


class Approve(BaseModel):
    """Approve the current map and sign the approval."""

    model_config = ConfigDict(extra="forbid")

    why: Why = ""
    confirmed: bool = False
    """Approve although accepted loop closures do not fit the graph; ``why`` is then required. It is
    also required if ``map.reason_needed`` of the state is not empty."""
    after_seq: Annotated[int | None, Field(ge=0, le=1 << 53)] = None
    """``seq`` of the state the signer saw; None = not checked."""
    graph: Annotated[str | None, Field(max_length=64)] = None
    """``graph`` of that state. Nothing is signed if either has changed. None = not checked."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StandingView:
    """The decision in force for a pair."""

    frame_i: int
    frame_j: int
    accepted: bool
    who: str
    why: str
    measured: bool
    """Whether a person registered the pair again."""
    T_i_j: list[float]
    """Result of that registration; empty = the automatic one applies."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OpinionView:
    """The last decision of a person about a pair."""

    who: str
    accepted: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkView:
    """The work of people on a pair."""

    frame_i: int
    frame_j: int
    assignee: str
    """Who has it; empty = nobody."""
    skipped_by: str
    """Who left it for later; empty = nobody."""
    second_by: str
    """Who asked for a second opinion; empty = nobody."""
    comments: int
    opinions: list[OpinionView]
    """Of each person who decided, one."""
    agreement: OpinionAgreement
    """What they say together."""
    waits: bool
    """Whether a second opinion was asked for, and two people do not agree yet."""


def work_view(work: PairWork) -> WorkView:
    """As the page shows it."""
    return WorkView(
        frame_i=work.pair[0],
        frame_j=work.pair[1],
        assignee=work.assignee,
        skipped_by=work.skipped_by,
        second_by=work.second_by,
        comments=work.comments,
        opinions=[OpinionView(who=one.who, accepted=one.accepted) for one in work.opinions],
        agreement=work.agreement,
        waits=work.waits,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class MapFacts:
    """What a person must know of a finished map before they approve it."""

    verdict: MapVerdict | None
    """None = the run worked none out: an earlier version of recon4 made the map."""
    reason_needed: str
    """Why the map is approved only with a typed reason; empty = without one."""
    min_reason_characters: int
    """Shortest reason that is accepted then."""
    notes: list[str]
    """Findings that do not change the verdict."""
    findings: list[SaidFinding] | None
    """All findings, worst first; null = an earlier version of recon4 made the map."""
    figures: dict[str, object]
    """The figures that an approval signs, by their names in ``summary.json``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReviewView:
    """The state of a review."""

    seq: int
    """Rows in the journal."""
    key: str
    """Key of the decisions in force."""
    graph: str
    """Key of the verified graph behind the queue; empty = there is none yet."""
    undoable: int
    redoable: int
    standing: list[StandingView]
    work: list[WorkView]
    """Of people on pairs that they decided, talked about or share."""
    obstacle: str
    """Why their work does not allow an approval yet; empty = it does."""
    in_map: bool
    """Whether the results include these decisions."""
    finished: bool
    """Whether the project has results."""
    map: MapFacts | None
    """Of the results; None = there are none yet."""
    busy: bool
    """Whether a job is queued or running."""
    may_review: bool
    may_process: bool
    approval: ApprovalState
    """Of the results."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SupersededEffect:
    """A newer decision was made meanwhile."""

    superseded: Literal[True] = True


@dataclass(frozen=True, slots=True, kw_only=True)
class RowView:
    """A row of the journal."""

    seq: int
    time: str
    who: str
    kind: str
    frame_i: int | None
    frame_j: int | None
    why: str
    hash: str


@dataclass(frozen=True, slots=True, kw_only=True)
class AlignmentView:
    """Result of a registration."""

    measurement: str
    """Id for ``NewDecision.measurement``; valid until the server stops or 500 newer ones exist."""
    T_i_j: list[float]
    converged: bool
    reason: str
    """Why the pair would be rejected automatically; empty = it would be accepted."""
    overlap: float | None
    error_m: float | None
    limit_m: float | None
    degeneracy: float | None
    iterations: int
