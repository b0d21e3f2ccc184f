"""Numbers in the names of frame files: which are missing, and which files are none of the row."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.model.derived import Derived
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.recording.clocks.tuning import FRAME_TIMES
from recon4.recording.frame_files.copies import original_of

_DIGITS = re.compile(r"(\d+)")


@dataclass(frozen=True, slots=True)
class NumberedFiles:
    """Frame files without those that are none."""

    files: tuple[Path, ...]
    left_out: tuple[Derived, ...] = ()
    """Which files are no frames, and why."""


def without_strangers(files: Sequence[Path]) -> NumberedFiles:
    """Frame files without copies under another kind of name, and without maps beside them.

    Args:
        files: In their order. Most have names of one kind, such as ``scan_0001.pcd``.
    """
    kinds = [_kind(file) for file in files]
    usual, number = Counter(kinds).most_common(1)[0]
    if number < FRAME_TIMES.alike_ratio * len(files) or "#" not in usual:
        return NumberedFiles(tuple(files))
    alike = [file for file, kind in zip(files, kinds, strict=True) if kind == usual]
    left_out: dict[Path, Derived] = {}
    for file in (file for file in files if file not in set(alike)):
        if original := original_of(file, alike):
            values: dict[str, Value] = {"name": file.name, "original": original.name}
            left_out[file] = Derived(kind=DerivedKind.FILE_COPY, values=values)
        elif not _DIGITS.search(file.stem):
            values = {"name": file.name, "files": len(alike)}
            left_out[file] = Derived(kind=DerivedKind.FILE_UNNUMBERED, values=values)
    kept = tuple(file for file in files if file not in left_out)
    return NumberedFiles(kept, tuple(left_out.values()))


def places_by_number(files: Sequence[Path]) -> NDArray[np.int64] | None:
    """Place of each file in a row without holes, from 0, (N,).

    The usual step from number to number is one place: of each third scan, 0, 3, 6, 12 are at 0, 1,
    2 and 4.

    Args:
        files: In the order of their numbers.

    Returns:
        None if the numbers tell no places: they are in no even row, or there are several a name.
    """
    numbers = numbers_of(files)
    if numbers is None or len(numbers) < FRAME_TIMES.fewest_numbers:
        return None
    steps = np.diff(numbers)
    values, counts = np.unique(steps, return_counts=True)
    usual = int(values[np.argmax(counts)])
    even = steps % usual == 0 if usual > 0 else np.zeros(len(steps), np.bool_)
    if not even.all() or counts.max() < FRAME_TIMES.row_ratio * len(steps):
        return None
    return np.asarray((numbers - numbers[0]) // usual)


def numbers_of(files: Sequence[Path]) -> NDArray[np.int64] | None:
    """The only number that differs in the names of files, (N,); None = there is no such one."""
    if len({_kind(file) for file in files}) != 1:
        return None
    columns = list(zip(*(_DIGITS.findall(file.stem) for file in files), strict=True))
    varying = [column for column in columns if len(set(column)) > 1]
    if len(varying) != 1 or max(map(int, varying[0])) >= 2**53:
        return None
    return np.array([int(text) for text in varying[0]], np.int64)


def _kind(file: Path) -> str:
    """A name with its numbers taken out."""
    return _DIGITS.sub("#", file.stem).lower()
