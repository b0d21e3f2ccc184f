"""What is asked of the compute pool: lanes, quotas, file access."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from types import MappingProxyType


class Lane(StrEnum):
    """Kinds of work. Each has its own slots, so that a slice never waits for the optimizer."""

    INSPECT = "inspect"
    """What a recording or a rig file holds."""
    THUMBNAIL = "thumbnail"
    """The map of a project from above."""
    SLICE = "slice"
    """Images and points of cuts."""
    PAIR = "pair"
    """Points of two places, and registering them."""
    REVIEW = "review"
    """Graphs: their queue of decisions, solving them."""
    EXPORT = "export"
    """Files of slices."""
    SURVEY = "survey"
    """References, control points, checks of the whole map."""
    SIGN = "sign"
    """Approvals: the only lane whose children can read the signing key."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Quota:
    """How much of a lane runs and waits."""

    slots: int = 1
    """Calls that run at the same time."""
    large_slots: int = 1
    """How many of them may be large."""
    per_person: int = 1
    """How many of them may be of one person."""
    waiting_per_person: int = 16
    """Calls of one person that may wait; more are refused (429)."""
    waiting: int = 200
    """Calls that may wait in all."""
    retry_after_s: float = 2.0
    """When a refused person is advised to try again [s]."""


QUOTAS: Mapping[Lane, Quota] = MappingProxyType(
    {
        Lane.INSPECT: Quota(slots=2),
        Lane.THUMBNAIL: Quota(waiting_per_person=64),
        Lane.SLICE: Quota(slots=2, large_slots=2),
        Lane.PAIR: Quota(slots=2, large_slots=2),
        Lane.REVIEW: Quota(),
        # The second slot is for small exports: six whole maps of one person leave it free.
        Lane.EXPORT: Quota(slots=2, per_person=2, waiting_per_person=8, retry_after_s=30.0),
        Lane.SURVEY: Quota(slots=2, per_person=2, waiting_per_person=8, retry_after_s=30.0),
        Lane.SIGN: Quota(waiting_per_person=4, retry_after_s=30.0),
    }
)


@dataclass(frozen=True, slots=True)
class FileAccess:
    """What a child may open besides the program itself and its own scratch folder."""

    read: tuple[Path, ...] = ()
    """Files, and folders with all that is below them."""
    write: tuple[Path, ...] = ()
    """The same, to be read and written."""


NO_FILES = FileAccess()
"""For work on values alone."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Terms:
    """Who asks for a call, and under which conditions it runs."""

    person: str
    access: FileAccess = NO_FILES
    outputs: Mapping[str, Path] = field(default_factory=dict)
    """What the call makes: name in the child's working folder -> where the server puts it."""
    large: bool = False
    """Takes long; small calls of the lane go first."""
    limit_s: float | None = None
    """Longest time it may run; None = as usual for its kind."""
