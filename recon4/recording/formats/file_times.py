"""Which files are of one recording, by their times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

from recon4.errors import UnknownFormat
from recon4.locales.coded import CodedText

_APART_NS = 3 * 3600 * 1_000_000_000
"""Files of one walk follow each other sooner, also after a break for lunch and other batteries."""
_NAMED = 8
_LATEST_NS = 253_402_300_800 * 1_000_000_000
"""Start of the year 10000."""


@dataclass(frozen=True, slots=True)
class FileTimes:
    """When a file was recorded."""

    path: Path
    t_first_ns: int
    t_last_ns: int


def require_one_walk(files: Sequence[FileTimes]) -> None:
    """Check that files were recorded one soon after the other, or at the same time.

    Files of different days in one folder are several walks: read as one, the walk would have a gap
    of days, and their sensors would be taken for those of one rig.

    Args:
        files: One item a file or folder, in any order.

    Raises:
        UnknownFormat: If they were not; each is a candidate.
    """
    ordered = sorted(files, key=lambda file: file.t_first_ns)
    walks: list[list[FileTimes]] = []
    last_ns = 0
    for file in ordered:
        if not walks or file.t_first_ns - last_ns > _APART_NS:
            walks.append([])
        walks[-1].append(file)
        last_ns = max(last_ns, file.t_last_ns)
    if len(walks) < 2:
        return
    named = [_text(walk) for walk in walks[:_NAMED]]
    more = " …" * (len(walks) > _NAMED)
    raise UnknownFormat(
        CodedText(
            "recordings-of-times",
            number=len(walks),
            hours=_APART_NS // 3600_000_000_000,
            walks="; ".join(named) + more,
        ),
        candidates=tuple(file.path for file in ordered),
    )


def utc(t_ns: int) -> str:
    """A time as text, to the millisecond; beyond the year 9999 in seconds."""
    if not 0 <= t_ns < _LATEST_NS:
        return f"{t_ns / 1e9:.3f} s since 1970"
    time = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(milliseconds=t_ns // 1_000_000)
    return time.strftime("%Y-%m-%d %H:%M:%S.%f")[:-3]


def _text(walk: Sequence[FileTimes]) -> str:
    names = ", ".join(file.path.name for file in walk[:_NAMED]) + " …" * (len(walk) > _NAMED)
    return f"{names} ({utc(walk[0].t_first_ns)} UTC)"
