"""Folders that all processes of a test run share, each made once.

`make test` runs pytest twice, side by side: both share the folder that ``RECON4_MADE_ONCE`` names.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Callable
from pathlib import Path

import pytest


def made_once(factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """A folder that the first process to ask for it makes; tests only read it.

    Args:
        factory: Where temporary folders of this run lie.
        name: Of the folder, unique in all runs.
        make: Makes the folder at the path it is given.
    """
    base = factory.getbasetemp()
    if shared := os.environ.get("RECON4_MADE_ONCE"):
        base = Path(shared)
    elif "PYTEST_XDIST_WORKER" in os.environ:
        base = base.parent  # of all workers
    folder = base / name
    with (base / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not folder.exists():
            half = base / f"{name}.half"
            make(half)
            half.rename(folder)
    return folder
