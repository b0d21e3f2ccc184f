"""Projects that no request can name, because of the names of their folders."""

from __future__ import annotations

import os
from pathlib import Path

from recon4.locales.coded import CodedText
from recon4.store.project import is_project
from recon4.untrusted.names import visible
from recon4_app.projects.store import PROJECT_ID
from recon4_app.projects.tuning import UNLISTED


def unlisted_notices(root: Path) -> list[str]:
    """A notice about projects below a folder whose names no request may have; mostly empty."""
    with os.scandir(root) as entries:
        names = sorted(entry.name for entry in entries if _is_unlisted(entry))
    if not names:
        return []
    shown = ", ".join(visible(name, most=64) for name in names[: UNLISTED.max_shown])
    more = " …" if len(names) > UNLISTED.max_shown else ""
    return [CodedText("notice-unlisted", names=shown + more, count=len(names))]


def _is_unlisted(entry: os.DirEntry[str]) -> bool:
    if PROJECT_ID.fullmatch(entry.name) or entry.name.startswith("."):
        return False
    return entry.is_dir(follow_symlinks=False) and is_project(Path(entry.path))
