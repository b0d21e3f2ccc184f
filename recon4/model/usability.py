"""The verdict on a map: what a person may do with it, and why not more."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import msgspec

from recon4.errors import StoreError
from recon4.locales.coded import unreadable
from recon4.untrusted.typed import as_type


class Usability(StrEnum):
    """Verdict on a map."""

    GOOD = "good"
    CHECK = "check"
    DO_NOT_USE = "do not use"


@dataclass(frozen=True, slots=True, kw_only=True)
class Unobserved:
    """A stretch of the walk along which one direction of the motion is hardly observed."""

    start_s: float
    """After the first multiframe [s]."""
    end_s: float
    direction: str
    """The weak direction: ``horizontal`` or ``vertical``; empty = not known."""
    degeneracy: float
    """Smallest eigenvalue of the normalized information, 0 = unobservable."""
    from_m: tuple[float, ...] = ()
    """Where it begins, x y z in the map [m]; empty = not known."""
    to_m: tuple[float, ...] = ()
    """Where it ends, x y z in the map [m]; empty = not known."""


@dataclass(frozen=True, slots=True)
class MapVerdict:
    """A usability and why it is not better."""

    usability: Usability
    reasons: tuple[str, ...]
    """The findings that led to it, worst first; empty for a good map."""
    unobserved: tuple[Unobserved, ...] = ()
    """What the LiDAR hardly observes, in order of time."""


def verdict_in(summary: Mapping[str, object]) -> MapVerdict | None:
    """The verdict in ``summary.json``; None where there is none, as in files of format 1.

    Raises:
        StoreError: If it cannot be read.
    """
    record = summary.get("verdict")
    if record is None:
        return None
    try:
        return as_type(record, MapVerdict)
    except msgspec.ValidationError as error:
        raise StoreError(unreadable("summary.json: its verdict", error)) from error
