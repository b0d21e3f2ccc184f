"""Temporary files of a viewer process, and the caches that lie there."""

from __future__ import annotations

import shutil
from pathlib import Path

from recon4.sandbox.private_cache import private_cache


def scratch_of(state: Path, project_id: str) -> Path:
    """Folder of a viewer's temporary files; removed when it ends."""
    return state / "viewers" / f"{project_id}.tmp"


def viewer_environment(scratch: Path) -> dict[str, str]:
    """Additional environment variables of a viewer: its cache folders, created here.

    The server sets them, because a viewer imports the kernels before it confines itself.
    """
    shutil.rmtree(scratch, ignore_errors=True)  # left by a viewer that was killed
    return private_cache(scratch / "caches")
