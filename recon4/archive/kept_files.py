"""Files that a server keeps of a map so that its pages open at once: made again when one is opened.

They lie in the state of the server, not in the project: what a project brings along is not trusted
to show what was approved. Their names begin with the key of the map.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator, Set
from pathlib import Path

from recon4.review.trusted_keys import STATE

KEPT = "pages"
"""What they are in lists of what takes space."""
KEPT_FOLDERS = ("slices", "thumbnails")
"""In the state of a server."""
_OF_MAP = re.compile(r"([0-9a-f]{16,64})[-.].+")


def state_of(project: Path) -> Path:
    """The state of the server in whose folder a project lies; it may not be there."""
    return project.resolve().parent / STATE


def kept_files(state: Path) -> Iterator[tuple[str, Path]]:
    """Key of the map and place of each kept file, or folder of files."""
    for folder in (state / name for name in KEPT_FOLDERS):
        for path in sorted(folder.iterdir()) if folder.is_dir() else ():
            found = _OF_MAP.fullmatch(path.name)
            if found and not path.is_symlink():
                yield found[1], path


def sweep_kept(state: Path, known: Set[str]) -> list[str]:
    """Remove what was kept of maps that are gone.

    Args:
        state: Of a server.
        known: Keys of all artifacts of its projects.

    Returns:
        The names removed.
    """
    gone = [path for key, path in kept_files(state) if key not in known]
    for path in gone:
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)
    return [path.name for path in gone]
