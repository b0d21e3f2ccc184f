"""Files that are in a recording twice, as after a copy under another name: one of them is read."""

from __future__ import annotations

import filecmp
from collections.abc import Sequence
from pathlib import Path

from recon4.model.derived_kinds import DerivedKind
from recon4.recording.report import ImportReport


def is_copy(one: Path, other: Path) -> bool:
    """Whether two files have the same bytes; those of other files differ near their beginning.

    Raises:
        OSError: If one of them cannot be read.
    """
    return filecmp.cmp(one, other, shallow=False)


def original_of(file: Path, others: Sequence[Path]) -> Path | None:
    """The first of some files that has the same bytes as another one; None = none has."""
    return next((other for other in others if other != file and is_copy(file, other)), None)


def without_copies(files: Sequence[Path], report: ImportReport) -> list[Path]:
    """The files in their order, each content once.

    Args:
        files: Files of one recording, not empty.
        report: Receives which are left out.

    Raises:
        OSError: If one of them cannot be read.
    """
    kept: list[Path] = []
    for file in files:
        is_new(file, kept, report)
    return kept


def is_new(file: Path, known: list[Path], report: ImportReport) -> bool:
    """Whether no file that is known has the same bytes; then it is known from now on.

    Args:
        file: Another one.
        known: Receives it.
        report: Receives which file it is a copy of.

    Raises:
        OSError: If one of them cannot be read.
    """
    original = original_of(file, known)
    if original is None:
        known.append(file)
        return True
    report.derive(DerivedKind.FILE_COPY, name=file.name, original=original.name)
    return False
