"""What the fuzzer knows about a kind of file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Reading:
    """What a reader returned."""

    count: int
    """Points, rows, poses, records."""
    salvaged: bool = False
    """The reader announced that something is missing."""


def _nothing_beside(folder: Path) -> None:
    """Most files are read alone."""


def _unknown(_: bytes) -> int | None:
    return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """A kind of file: valid seeds, and the reader that the program uses for it."""

    name: str
    file_name: str
    """Below the folder of the trial."""
    seeds: Callable[[], Sequence[bytes]]
    read: Callable[[Path], Reading]
    """Is given the path of the file; may raise."""
    prepare: Callable[[Path], None] = _nothing_beside
    """Puts files beside the one that is read, once."""
    promised: Callable[[bytes], int | None] = _unknown
    """The count in the header, parsed independently; None = the format has none."""
    knows_end: bool = True
    """Whether a reader can know that the end of a file is missing."""
    repair: Callable[[bytes], bytes] | None = None
    """Makes checksums fit again, so that mutants get past them."""
    header_bytes: int = 512
    """Where sizes are mutated."""
