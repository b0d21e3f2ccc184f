"""Parameters of calls of the compute pool: lanes, quotas, file access."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from types import MappingProxyType


class Lane(StrEnum):
    """Kinds of work. Each has its own slots, so that a slice never waits for the optimizer."""

    INSPECT = "inspect"
    """Content of a recording or a rig file."""
    THUMBNAIL = "thumbnail"
    """Thumbnails of projects: the map from above."""
    SLICE = "slice"
    """Images and points of slices."""
    PAIR = "pair"
    """Points of two nodes, and their registration."""
    REVIEW = "review"
    """Graphs: the review queue, and solving them."""
    EXPORT = "export"
    """Files of slices."""
    SURVEY = "survey"
    """References, control points, checks of the whole map."""
    SIGN = "sign"
    """Approvals and reports: the only lane whose children can read the signing key."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Quota:
    """Limits of a lane."""

    slots: int = 1
    """Calls that run at the same time."""
    large_slots: int = 1
    """Most of them that may be large."""
    per_person: int = 1
    """Most of them per person."""
    waiting_per_person: int = 16
    """Most waiting calls per person; more are rejected (429)."""
    waiting: int = 200
    """Most waiting calls in total."""
    retry_after_s: float = 2.0
    """``Retry-After`` of a rejected call [s]."""


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
    """Files a child may open besides the program itself and its own scratch folder."""

    read: tuple[Path, ...] = ()
    """Files, and folders with everything below them."""
    write: tuple[Path, ...] = ()
    """The same, to be read and written."""


NO_FILES = FileAccess()
"""For work on values alone."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Terms:
    """Conditions of a call: its person, files and limits."""

    person: str
    access: FileAccess = NO_FILES
    outputs: Mapping[str, Path] = field(default_factory=dict)
    """Output files: name in the child's working folder -> path to which the server moves it."""
    large: bool = False
    """Whether it takes long; small calls of the lane go first."""
    limit_s: float | None = None
    """Longest time it may run [s]; None = the default of its kind."""
