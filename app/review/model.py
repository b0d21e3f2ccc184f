"""The review as the pages see it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from app.names import Note

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
    """The pose that was looked at, x y z qx qy qz qw; empty if there was none."""
    measurement: Annotated[str, Field(max_length=64)] = ""
    """Of ``replace`` and ``add``: what ``align`` called its result."""


class Step(BaseModel):
    """Undo or redo."""

    model_config = ConfigDict(extra="forbid")

    after_seq: int | None = None
    """Refuse if the last row of the journal is another one; null = any."""
    why: Why = ""


class Guess(BaseModel):
    """Where a registration is to begin."""

    model_config = ConfigDict(extra="forbid")

    frame_i: Frame
    frame_j: Frame
    T_i_j: PoseNumbers


Point = Annotated[list[Finite], Field(min_length=3, max_length=3)]


class PointPairs(BaseModel):
    """The same points in both places."""

    model_config = ConfigDict(extra="forbid")

    p_i: Annotated[list[Point], Field(min_length=3, max_length=20)]
    """In the body frame of the first [m]."""
    p_j: Annotated[list[Point], Field(min_length=3, max_length=20)]
    """In the body frame of the second [m]."""


class Approve(BaseModel):
    """Sign the map as it is."""

    model_config = ConfigDict(extra="forbid")

    why: Why = ""
    confirmed: bool = False
    """Sign although accepted pairs do not fit the graph; asks for a reason."""
    after_seq: Annotated[int | None, Field(ge=0, le=1 << 53)] = None
    """``seq`` of the state the signer looked at …"""
    graph: Annotated[str | None, Field(max_length=64)] = None
    """… and its ``graph``: if either is another one by now nothing is signed. None = not said."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StandingView:
    """What holds for a pair."""

    frame_i: int
    frame_j: int
    accepted: bool
    who: str
    why: str
    measured: bool
    """Whether a person measured it anew."""
    T_i_j: list[float]
    """That measurement; empty = that of the program."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReviewView:
    """The state of a review."""

    seq: int
    """Rows in the journal."""
    key: str
    """Of the decisions that stand."""
    graph: str
    """Key of the verified graph the queue is made of; empty = there is none yet."""
    undoable: int
    redoable: int
    standing: list[StandingView]
    in_map: bool
    """Whether the results were made with these decisions."""
    finished: bool
    """Whether there are results."""
    busy: bool
    """Whether a job waits or runs."""
    may_review: bool
    may_process: bool
    approval: dict[str, Any] | None
    """The newest approval: version, who, when, hash, and whether it is of these results. Of these
    also ``check``: ``checked``, ``checking`` or ``altered``, with the reason in ``altered``."""


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
    """What a registration found."""

    measurement: str
    """Name by which a decision may bring it; known until the server ends, or 500 more are made."""
    T_i_j: list[float]
    converged: bool
    reason: str
    """Why the program would turn it down; empty = it would not."""
    overlap: float | None
    error_m: float | None
    limit_m: float | None
    degeneracy: float | None
    iterations: int
