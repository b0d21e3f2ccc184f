"""Disk space: checked before a job is accepted, and again before it begins."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable
from pathlib import Path

from recon4.errors import NoSpace
from recon4.locales.coded import CodedText
from recon4_app.jobs.tuning import SPACE


def refuse_if_full(project: Path, inputs: Iterable[Path], *, reserve_bytes: int) -> None:
    """Reject a job for which the disk has too little space; existing files of the project count.

    Raises:
        NoSpace: With the needed and the free bytes.
    """
    given = sum(size_below(path) for path in inputs)
    needed = max(0, SPACE.times_the_input * given - size_below(project)) + reserve_bytes
    there = next(folder for folder in (project, *project.parents) if folder.exists())
    free = shutil.disk_usage(there).free
    if free < needed:
        raise NoSpace(
            CodedText(
                "job-no-space",
                needed_bytes=needed,
                times=SPACE.times_the_input,
                given_bytes=given,
                free_bytes=free,
            )
        )


def size_below(path: Path) -> int:
    """Bytes of a file, or of all files below a folder; 0 when there is nothing.

    A file with several names (hard links) counts once.
    """
    if path.is_file():
        return path.stat().st_size
    sizes: dict[tuple[int, int], int] = {}
    for parent, _, names in os.walk(path):
        for name in names:
            try:
                status = os.stat(os.path.join(parent, name), follow_symlinks=False)
            except FileNotFoundError:
                continue  # a running job removes files
            sizes[status.st_dev, status.st_ino] = status.st_size
    return sum(sizes.values())
