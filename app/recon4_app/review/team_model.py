"""Requests and responses of several people who review one map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from recon4_app.names import Name
from recon4_app.review.model import Frame, Why

PageToken = Annotated[str, Field(pattern=r"^[0-9a-z]{8,20}$")]


class NewWork(BaseModel):
    """What a person does with a pair without deciding about it."""

    model_config = ConfigDict(extra="forbid")

    kind: Literal["assign", "comment", "skip", "second", "waive"]
    """``second`` asks for a second opinion, ``waive`` withdraws the question."""
    frame_i: Frame
    frame_j: Frame
    why: Why = ""
    """Text of a comment; of the others a reason."""
    assignee: Annotated[Name, Field(max_length=64)] = ""
    """Of ``assign``: a person who may review; empty = nobody."""


class Looking(BaseModel):
    """Which pair a page shows now."""

    model_config = ConfigDict(extra="forbid")

    page: PageToken
    """Random, of one page in one browser."""
    frame_i: Frame | None = None
    """None = no pair."""
    frame_j: Frame | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class LookerView:
    """Somebody who has the review page open."""

    who: str
    frame_i: int | None
    """Of the pair that the page shows; null = none."""
    frame_j: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class CommentView:
    """A comment on a pair."""

    who: str
    time: str
    """UTC, ISO 8601."""
    text: str
