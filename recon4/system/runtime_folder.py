"""The folder of this user's sockets: short, and closed to every other user.

A Unix socket's path has at most 103 bytes (macOS; 107 on Linux), and a project may lie deep.
"""

from __future__ import annotations

import contextlib
import os
import stat
import tempfile
from pathlib import Path

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.system.tuning import RUNTIME_FOLDERS

_SHARED_TEMPORARY = Path(tempfile.gettempdir())
"""Where all processes of this user meet; a confined one has a temporary folder of its own later."""


def runtime_folder() -> Path:
    """This user's folder for sockets, made if there is none; the same for every process.

    Raises:
        StoreError: If another user has taken every place there is.
    """
    problems = []
    for path in _places():
        if len(os.fsencode(path)) > RUNTIME_FOLDERS.longest_folder:
            continue
        try:
            return private_folder(path)
        except (OSError, StoreError) as error:
            problems.append(str(error))
    raise StoreError(CodedText("sockets-no-place", problems="; ".join(problems)))


def private_folder(path: Path) -> Path:
    """A folder that belongs to this user alone (0700), made if there is none.

    Raises:
        StoreError: If another user owns it, others may enter it, or it is a link or a file.
    """
    with contextlib.suppress(FileExistsError):
        path.mkdir(mode=0o700)
    found = path.lstat()
    mode = stat.S_IMODE(found.st_mode)
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid() or mode & 0o077:
        raise StoreError(
            CodedText(
                "sockets-folder",
                file=str(path),
                user=os.getuid(),
                mode=stat.filemode(found.st_mode),
                owner=found.st_uid,
            )
        )
    return path


def _places() -> list[Path]:
    """Where it may be, the best first. The second is for a place another user squats on."""
    name = f"recon4-{os.getuid()}"
    places = [_SHARED_TEMPORARY / name, Path("/tmp") / name]
    if session := os.environ.get("XDG_RUNTIME_DIR"):
        places.append(Path(session) / "recon4")
    with contextlib.suppress(RuntimeError):  # a user without a home
        places.append(Path.home() / ".cache" / "recon4-sockets")
    return places
